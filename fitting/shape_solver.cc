// SPDX-License-Identifier: MIT
#include "fitting/shape_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fitting/box_qp.h"

namespace articap {
namespace {

constexpr double kAbsoluteTolerance_mm = 1e-12;

// Parameters that no marker sees have no curvature; this keeps the model definite and leaves them.
constexpr double kRidge = 1e-12;

constexpr int kMaxInnerSteps = 100;

// The inner problem need not be solved better than the linearisation is good: until a step promises
// less than this part of what the steps before it have gained.
constexpr double kInnerTolerance = 3e-4;

// A move must keep this part of what its linearisation promised.
constexpr double kSufficientPart = 0.1;

// The curvature share of the next inner step, from how much of its promise the last one kept.
double NextShare(double share, double kept) {
  if (kept < 0.25) return share > 0.3 ? 0.5 * share : 0;
  return kept > 0.75 ? 1 - 0.3 * (1 - share) : share;
}

}  // namespace

ShapeSolver::ShapeSolver(const VirtualMarkerEvaluator& evaluator, Eigen::VectorXd lower,
                         Eigen::VectorXd upper, const ShapeSolverOptions& options)
    : frame_(evaluator, options.loss),
      lower_(std::move(lower)),
      upper_(std::move(upper)),
      options_(options) {}

double ShapeSolver::ToleranceOf(double objective) const {
  return options_.relative_tolerance * objective + kAbsoluteTolerance_mm;
}

// The step from move_ that minimises the quadratic model within the box; returns the decrease that
// the model promises. With a share of 0 the model majorises the objective, with 1 it is Newton's.
double ShapeSolver::SolveModel(double curvature_share) {
  model_ = current_.reweighted_hessian + curvature_share * current_.loss_curvature;
  model_.diagonal().array() += kRidge;
  step_ = SolveBoxQp(model_, current_.gradient, box_lower_ - move_, box_upper_ - move_);
  return -current_.gradient.dot(step_) - 0.5 * step_.dot(model_ * step_);
}

// Minimises the loss of the linearised residuals over the box; move_ becomes the minimiser. Returns
// by how much that loss falls.
double ShapeSolver::MinimizeLinearized(double curvature_share) {
  const double objective = current_.objective;
  const double tolerance = ToleranceOf(objective);
  for (int i = 0; i < kMaxInnerSteps; ++i) {
    const double promised = SolveModel(curvature_share);
    const double gained = objective - current_.objective;
    if (promised <= std::max(tolerance, kInnerTolerance * gained)) break;
    candidate_move_ = (move_ + step_).cwiseMax(box_lower_).cwiseMin(box_upper_);
    frame_.Build(candidate_move_, &candidate_);
    const double decrease = current_.objective - candidate_.objective;
    if (decrease > 0) {
      std::swap(move_, candidate_move_);
      std::swap(current_, candidate_);
    } else if (curvature_share == 0) {
      break;  // the majorising model failed: only rounding is left
    }
    curvature_share = NextShare(curvature_share, decrease / promised);
  }
  return objective - current_.objective;
}

ShapeSolution ShapeSolver::Solve(MarkerPositions measured_in_rig, Eigen::VectorXd* parameters) {
  ShapeSolution solution;
  *parameters = parameters->cwiseMax(lower_).cwiseMin(upper_);
  Eigen::VectorXd start = *parameters;
  double start_objective = std::numeric_limits<double>::infinity();
  double promised = 0, last_promised = 0;
  while (solution.evaluations < options_.max_evaluations) {
    frame_.Linearize(measured_in_rig, *parameters);
    ++solution.evaluations;
    candidate_move_.setZero(parameters->size());
    frame_.Build(candidate_move_, &current_);
    if (current_.objective > start_objective - kSufficientPart * promised) {
      move_ *= 0.5;
      promised *= 0.5;
      solution.converged = promised <= ToleranceOf(start_objective);
      *parameters = start + (solution.converged ? 0 : 1) * move_;
      if (solution.converged) break;
      continue;
    }
    start = *parameters;
    start_objective = current_.objective;
    move_.swap(candidate_move_);
    box_lower_ = lower_ - start;
    box_upper_ = upper_ - start;
    last_promised = promised;
    promised = MinimizeLinearized(solution.evaluations == 1 ? 0 : 1);
    *parameters = (start + move_).cwiseMax(lower_).cwiseMin(upper_);
    solution.objective = current_.objective;
    // The promises fall by about a constant factor, which the root of the last one overestimates.
    const double foreseen =
        last_promised > 0 ? promised * std::sqrt(promised / last_promised) : promised;
    if (foreseen <= ToleranceOf(start_objective)) {
      solution.converged = true;
      break;
    }
  }
  return solution;
}

}  // namespace articap
