// SPDX-License-Identifier: MIT
#include "fitting/box_qp.h"

#include <Eigen/Cholesky>
#include <array>
#include <vector>

#include "core/check.h"

namespace articap {
namespace {

enum class Place : unsigned char { kFree, kLower, kUpper };

// Minimiser over the free variables, the others fixed at x.
void SolveFree(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
               const std::vector<int>& free, Eigen::VectorXd* x) {
  const int num_free = static_cast<int>(free.size());
  // On the stack for the sizes that occur every frame.
  constexpr int kStackSize = 16;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kStackSize, kStackSize>;
  const Eigen::VectorXd at_fixed = gradient + hessian * *x;
  const auto solve = [&](auto reduced, auto right) {
    for (int i = 0; i < num_free; ++i) {
      right[i] = at_fixed[free[i]];
      for (int k = 0; k <= i; ++k) reduced(i, k) = hessian(free[i], free[k]);
    }
    Eigen::LLT<Eigen::Ref<decltype(reduced)>> factor(reduced);
    factor.solveInPlace(right);
    for (int i = 0; i < num_free; ++i) (*x)[free[i]] = -right[i];
  };
  if (num_free <= kStackSize)
    solve(Small(num_free, num_free),
          Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kStackSize, 1>(num_free));
  else
    solve(Eigen::MatrixXd(num_free, num_free), Eigen::VectorXd(num_free));
}

}  // namespace

Eigen::VectorXd SolveBoxQp(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const int size = static_cast<int>(gradient.size());
  std::vector<Place> places(size, Place::kFree);
  for (int i = 0; i < size; ++i) {
    ARTICAP_CHECK(lower[i] <= 0 && upper[i] >= 0);
    if (lower[i] == upper[i]) places[i] = Place::kLower;
  }

  Eigen::VectorXd x(size);
  std::vector<int> free;
  // Each round fixes or frees a variable; cycles are cut off, and what they end with is clamped.
  for (int round = 0; round < 3 * size + 3; ++round) {
    free.clear();
    for (int i = 0; i < size; ++i) {
      x[i] = places[i] == Place::kFree ? 0 : places[i] == Place::kLower ? lower[i] : upper[i];
      if (places[i] == Place::kFree) free.push_back(i);
    }
    if (!free.empty()) SolveFree(hessian, gradient, free, &x);

    bool left_the_box = false;
    for (const int i : free) {
      if (x[i] < lower[i]) places[i] = Place::kLower;
      if (x[i] > upper[i]) places[i] = Place::kUpper;
      left_the_box |= places[i] != Place::kFree;
    }
    if (left_the_box) continue;

    const Eigen::VectorXd slope = gradient + hessian * x;
    int worst = -1;
    double worst_slope = 0;
    for (int i = 0; i < size; ++i) {
      if (places[i] == Place::kFree || lower[i] == upper[i]) continue;
      const double inward = places[i] == Place::kLower ? -slope[i] : slope[i];
      if (inward > worst_slope) {
        worst_slope = inward;
        worst = i;
      }
    }
    if (worst < 0) return x;
    places[worst] = Place::kFree;
  }
  return x.cwiseMax(lower).cwiseMin(upper);
}

}  // namespace articap
