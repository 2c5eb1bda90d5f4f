// SPDX-License-Identifier: MIT
#include "rig/default_head/curve.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace articap {

Curve::Curve(const std::vector<Eigen::Vector2d>& knots) {
  ARTICAP_CHECK_GE(knots.size(), 2u);
  for (const Eigen::Vector2d& knot : knots) {
    if (!x_.empty()) ARTICAP_CHECK_LT(x_.back(), knot.x());
    x_.push_back(knot.x());
    y_.push_back(knot.y());
  }
  const std::size_t last = x_.size() - 1;
  std::vector<double> secant(last);
  for (std::size_t i = 0; i < last; ++i) secant[i] = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
  slope_.assign(x_.size(), 0);
  slope_.front() = secant.front();
  slope_.back() = secant.back();
  // The harmonic mean of the neighbouring secants keeps each piece monotone.
  for (std::size_t i = 1; i < last; ++i)
    if (secant[i - 1] * secant[i] > 0)
      slope_[i] = 2 * secant[i - 1] * secant[i] / (secant[i - 1] + secant[i]);
}

double Curve::operator()(double x) const {
  if (x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const std::size_t i = std::upper_bound(x_.begin(), x_.end(), x) - x_.begin() - 1;
  const double width = x_[i + 1] - x_[i];
  const double u = (x - x_[i]) / width;
  const double v = 1 - u;
  return v * v * (1 + 2 * u) * y_[i] + u * u * (1 + 2 * v) * y_[i + 1] +
         width * u * v * (v * slope_[i] - u * slope_[i + 1]);
}

double SmoothStep(double from, double to, double x) {
  const double u = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return u * u * u * (u * (6 * u - 15) + 10);
}

double SmoothMax(double a, double b, double width) {
  const double overlap = std::max(width - std::abs(a - b), 0.0) / width;
  return std::max(a, b) + 0.25 * width * overlap * overlap;
}

double Bell(double x) { return std::exp(-0.5 * x * x); }

}  // namespace articap
