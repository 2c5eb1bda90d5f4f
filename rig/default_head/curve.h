// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <initializer_list>
#include <vector>

namespace articap {

// A function through given points, smooth and without overshoot (Fritsch and Carlson 1980); constant
// outside of them.
class Curve {
 public:
  // {abscissa, value} in rising order of the abscissae.
  explicit Curve(const std::vector<Eigen::Vector2d>& knots);
  Curve(std::initializer_list<Eigen::Vector2d> knots)
      : Curve(std::vector<Eigen::Vector2d>(knots)) {}

  double operator()(double x) const;

 private:
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> slope_;
};

// 0 below `from`, 1 above `to` (either may be the larger), smooth between.
double SmoothStep(double from, double to, double x);

// The larger of two, rounded where they differ by less than `width`.
double SmoothMax(double a, double b, double width);

// exp(-x^2 / 2)
double Bell(double x);

}  // namespace articap
