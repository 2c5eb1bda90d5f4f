// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/network.h"

namespace articap {

using ResidualLists = std::vector<std::vector<Eigen::Vector2d>>;

// Median distance over all corners, px.
double MedianOf(const ResidualLists& residuals_px);
// Standard deviation of one coordinate, px, by the median: outliers do not touch it.
double RobustSigmaOf(const ResidualLists& residuals_px);

// A sighting that does not fit the others.
struct BadSighting {
  int sighting = 0;  // index in the network
  std::string reason;
};

// Sightings whose residuals are far above those of their view's others, as a camera may be noisier
// than the rest: the root mean square above three times the median's and above the median by six
// deviations (1.4826 MAD). The reason names the displaced corners.
std::vector<BadSighting> ScreenSightings(const AdjustedNetwork& adjusted);

// "corner 12 by 3.4 px, corner 13 by 2.9 px and 4 more", of those more than six sigmas off.
std::string DisplacedCorners(const std::vector<int>& corners,
                             const std::vector<Eigen::Vector2d>& residuals_px, double sigma_px);

}  // namespace articap
