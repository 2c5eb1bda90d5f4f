// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

namespace articap {

// What a marker's residual costs; the objective is the sum over the markers.
enum class FitMetric : std::uint8_t {
  kDistance,  // sqrt(d^2 + epsilon^2): the paper's sum of Euclidean distances, made smooth
  kSquared,   // d^2
  kHuber,     // d^2 up to delta, then 2 delta d - delta^2
};

struct MarkerLoss {
  FitMetric metric = FitMetric::kDistance;
  double epsilon_mm = 0.001;
  double huber_delta_mm = 1;

  // Cost and its first and second derivative with respect to the squared distance, d^2.
  struct Value {
    double cost, first, second;
  };
  Value operator()(double squared_distance) const {
    switch (metric) {
      case FitMetric::kDistance: {
        const double distance = std::sqrt(squared_distance + epsilon_mm * epsilon_mm);
        const double inverse = 1 / distance;
        return {distance, 0.5 * inverse, -0.25 * inverse * inverse * inverse};
      }
      case FitMetric::kHuber:
        if (squared_distance > huber_delta_mm * huber_delta_mm) {
          const double distance = std::sqrt(squared_distance);
          return {(2 * distance - huber_delta_mm) * huber_delta_mm, huber_delta_mm / distance,
                  -0.5 * huber_delta_mm / (squared_distance * distance)};
        }
        [[fallthrough]];
      case FitMetric::kSquared:
        break;
    }
    return {squared_distance, 1, 0};
  }
};

}  // namespace articap
