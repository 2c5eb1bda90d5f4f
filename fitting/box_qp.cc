// SPDX-License-Identifier: MIT
#include "fitting/box_qp.h"

#include <Eigen/Cholesky>
#include <utility>
#include <vector>

#include "core/check.h"

namespace articap {
namespace {

// Sets the free variables of x to the minimiser for the others as they are; false where the hessian
// is not definite by rounding, and x of no use.
bool SolveFree(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
               const std::vector<int>& free, Eigen::VectorXd* x) {
  const int num_free = static_cast<int>(free.size());
  // On the stack for the sizes that occur every frame.
  constexpr int kStackSize = 16;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kStackSize, kStackSize>;
  for (const int i : free) (*x)[i] = 0;
  const Eigen::VectorXd at_fixed = gradient + hessian * *x;
  const auto solve = [&](auto reduced, auto right) {
    for (int i = 0; i < num_free; ++i) {
      right[i] = at_fixed[free[i]];
      for (int k = 0; k <= i; ++k) reduced(i, k) = hessian(free[i], free[k]);
    }
    Eigen::LLT<Eigen::Ref<decltype(reduced)>> factor(reduced);
    if (factor.info() != Eigen::Success) return false;
    factor.solveInPlace(right);
    for (int i = 0; i < num_free; ++i) (*x)[free[i]] = -right[i];
    return true;
  };
  if (num_free <= kStackSize)
    return solve(Small(num_free, num_free),
                 Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kStackSize, 1>(num_free));
  return solve(Eigen::MatrixXd(num_free, num_free), Eigen::VectorXd(num_free));
}

// How far towards `target` the free variables of x can go, and which of them stops it, or -1.
std::pair<double, int> StepToBoundary(const Eigen::VectorXd& x, const Eigen::VectorXd& target,
                                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                      const std::vector<int>& free) {
  double part = 1;
  int blocking = -1;
  for (const int i : free) {
    const double bound = target[i] < lower[i] ? lower[i] : upper[i];
    if (target[i] >= lower[i] && target[i] <= upper[i]) continue;
    const double reachable = (bound - x[i]) / (target[i] - x[i]);
    if (reachable < part) {
      part = reachable;
      blocking = i;
    }
  }
  return {part, blocking};
}

// The fixed variable whose objective falls fastest into the box, or -1 where none does.
int WorstFixed(const Eigen::VectorXd& x, const Eigen::VectorXd& slope, const Eigen::VectorXd& lower,
               const Eigen::VectorXd& upper, const std::vector<bool>& is_free) {
  int worst = -1;
  double worst_slope = 0;
  for (int i = 0; i < x.size(); ++i) {
    if (is_free[i] || lower[i] == upper[i]) continue;
    const double inward = x[i] == lower[i] ? -slope[i] : slope[i];
    if (inward > worst_slope) {
      worst_slope = inward;
      worst = i;
    }
  }
  return worst;
}

}  // namespace

Eigen::VectorXd SolveBoxQp(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const int size = static_cast<int>(gradient.size());
  ARTICAP_CHECK((lower.array() <= 0).all() && (upper.array() >= 0).all());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  std::vector<bool> is_free(size);
  for (int i = 0; i < size; ++i)
    is_free[i] = !((lower[i] == 0 && gradient[i] >= 0) || (upper[i] == 0 && gradient[i] <= 0));

  std::vector<int> free;
  // Each round fixes or frees one variable, never raising the objective. More rounds than this are
  // taken by rounding alone, at a point as good as the minimum.
  for (int round = 0; round < 10 * size; ++round) {
    free.clear();
    for (int i = 0; i < size; ++i)
      if (is_free[i]) free.push_back(i);
    Eigen::VectorXd target = x;
    if (!free.empty() && !SolveFree(hessian, gradient, free, &target)) break;

    const auto [part, blocking] = StepToBoundary(x, target, lower, upper, free);
    if (blocking >= 0) {
      x += part * (target - x);
      x[blocking] = target[blocking] < lower[blocking] ? lower[blocking] : upper[blocking];
      is_free[blocking] = false;
      continue;
    }
    x = target;
    const int worst = WorstFixed(x, gradient + hessian * x, lower, upper, is_free);
    if (worst < 0) break;
    is_free[worst] = true;
  }
  return x.cwiseMax(lower).cwiseMin(upper);
}

}  // namespace articap
