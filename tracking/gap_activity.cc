// SPDX-License-Identifier: MIT
#include "tracking/gap_activity.h"

#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace articap {
namespace {

constexpr double kFloor = 0.01;
constexpr std::array kExponents = {0.0, 0.25, 0.5, 0.75, 1.0};
constexpr std::size_t kFewest = 100;

}  // namespace

double ActivityModel::VarianceFactor(double activity) const {
  return scale * std::pow(activity + kFloor, exponent);
}

ActivityModel FitActivity(const std::vector<double>& activities,
                          const std::vector<double>& relative_squares) {
  ARTICAP_CHECK_EQ(activities.size(), relative_squares.size());
  ActivityModel best;
  if (activities.size() < kFewest) return best;
  const auto count = static_cast<double>(activities.size());
  double least = std::numeric_limits<double>::infinity();
  for (const double exponent : kExponents) {
    // The scale that makes the mean of square over variance one is the most likely one, and leaves
    // -2 log likelihood = count log scale + sum of the logarithms of the powers.
    double sum = 0;
    double sum_of_logarithms = 0;
    for (std::size_t i = 0; i < activities.size(); ++i) {
      const double power = std::pow(activities[i] + kFloor, exponent);
      sum += relative_squares[i] / power;
      sum_of_logarithms += std::log(power);
    }
    if (!(sum > 0)) return best;
    const double criterion = count * std::log(sum / count) + sum_of_logarithms;
    if (criterion < least) {
      least = criterion;
      best = {exponent, sum / count};
    }
  }
  return best;
}

}  // namespace articap
