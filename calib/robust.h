// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/camera.h"

namespace articap {

// Standard deviation of one coordinate of two-dimensional Gaussian errors, from the median of their
// distances: outliers do not touch it.
double RobustSigmaOf(std::vector<double> distances_px);

// What a view may be off before everything is adjusted, px: lenses and poses are still rough, and
// cameras may not quite be synchronous.
double RoughTolerance_px(const Camera& camera);

// What Huber's loss makes of residuals: psi(r) = min(r, k) for a distance r, its weight psi(r) / r,
// its slope the mean one of both axes: 1 below k, half the weight above, where psi only turns.
struct HuberSums {
  double squares_px2 = 0;  // of psi
  double weights = 0;
  double slopes = 0;
  int count = 0;

  // k = 0: plain least squares.
  void Add(double distance_px, double huber_px);
  HuberSums& operator+=(const HuberSums& other);
  double mean_weight() const { return count > 0 ? weights / count : 1; }
  // Standard deviation of one coordinate without the outliers: that of psi, over the mean slope of
  // psi. NaN where there are no degrees of freedom. With it, sigma^2 mean_weight (J' W J)^-1 is the
  // covariance of what was estimated.
  // P. J. Huber, "Robust Statistics", 1981, section 7.6.
  double Sigma_px(double degrees_of_freedom) const;
};

}  // namespace articap
