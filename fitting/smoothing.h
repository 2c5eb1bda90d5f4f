// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "core/tracks.h"
#include "fitting/frame_fits.h"

namespace articap {

// Minimises, over all frames of the take at once,
//   sum_f loss(frame f, y_f) + sum_f sum_k w_k (y_{f+1,k} - 2 y_{f,k} + y_{f-1,k})^2
// within the bounds, from the frame-by-frame fits, which it overwrites: a prior on smooth
// trajectories. Frames without a fit stay without, and the prior does not reach across them. Damped
// Newton steps on the banded system; returns their number.
int SmoothFits(const RigTracks& measured, const FrameFitSetup& setup,
               const Eigen::VectorXd& weights, FrameFits* fits);

}  // namespace articap
