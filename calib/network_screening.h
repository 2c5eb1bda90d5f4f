// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "calib/calibration.h"
#include "calib/network.h"

namespace articap {

struct ScreenOptions {
  double huber_sigmas = 3;  // 0: plain least squares
  bool set_views_aside = true;
};

// Huber's loss for residuals like these where views weigh by their noise, px of the usual one; 0
// for none.
double HuberFor_px(const AdjustedNetwork& adjusted, const std::vector<double>& relative_noise,
                   double sigmas);

// Adjusts, sets aside what does not fit the rest, and adjusts again, until everything fits and
// every view weighs by its own noise. The sightings left out are added to `set_aside`; weights and
// Huber's loss are left in `adjust`.
AdjustedNetwork AdjustAndScreen(Network network, AdjustOptions& adjust,
                                const ScreenOptions& options, LeftOutSightings& set_aside);

// Sightings that did not even come into the network: no pose of the board explains their corners.
void SetAsideUnplaced(std::span<const CameraSightings> cameras, const Network& network,
                      LeftOutSightings& set_aside);

}  // namespace articap
