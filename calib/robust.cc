// SPDX-License-Identifier: MIT
#include "calib/robust.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/statistics.h"

namespace articap {

double RobustSigmaOf(std::vector<double> distances_px) {
  // The median of Rayleigh's distribution over its sigma.
  return MedianOf(std::move(distances_px)) / std::sqrt(2 * std::log(2.0));
}

double RoughTolerance_px(const Camera& camera) {
  return std::max(6.0, 0.01 * std::max(camera.width, camera.height));
}

void HuberSums::Add(double distance_px, double huber_px) {
  const double psi = huber_px > 0 ? std::min(distance_px, huber_px) : distance_px;
  squares_px2 += psi * psi;
  const double weight = distance_px > 0 ? psi / distance_px : 1;
  weights += weight;
  slopes += psi < distance_px ? weight / 2 : 1;
  ++count;
}

HuberSums& HuberSums::operator+=(const HuberSums& other) {
  squares_px2 += other.squares_px2;
  weights += other.weights;
  slopes += other.slopes;
  count += other.count;
  return *this;
}

double HuberSums::Sigma_px(double degrees_of_freedom) const {
  if (!(degrees_of_freedom > 0)) return NAN;
  return std::sqrt(squares_px2 / degrees_of_freedom) * count / slopes;
}

}  // namespace articap
