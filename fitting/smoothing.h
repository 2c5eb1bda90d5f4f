// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "core/tracks.h"
#include "fitting/frame_fits.h"

namespace articap {

struct Smoothing {
  int steps = 0;
  bool converged = true;
};

// Minimises, over all frames of the take at once,
//   sum_f loss(frame f, y_f) + sum_f sum_k w_k (y_{f+1,k} - 2 y_{f,k} + y_{f-1,k})^2
// within the bounds, from the frame-by-frame fits, which it overwrites: a prior on smooth
// trajectories. Frames without a fit stay without, and the prior does not reach across them. Where
// a frame's markers do not determine a parameter, it follows its neighbours. Damped Newton steps on
// the banded system.
Smoothing SmoothFits(const RigTracks& measured, const FrameFitSetup& setup,
                     const Eigen::VectorXd& weights, FrameFits* fits);

}  // namespace articap
