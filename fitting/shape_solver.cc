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

// Parameters that no marker sees have no curvature; this part of the largest keeps the model
// definite and leaves them.
constexpr double kRidge = 1e-13;

// Convergence is foreseen no faster than by this factor a step.
constexpr double kFastestConvergence = 0.01;

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

// What the move after the next can still promise: promises fall by a constant factor in the end, of
// which the root of the last one is a cautious guess.
double Foreseen(double promised, double last_promised) {
  if (!(last_promised > 0)) return promised;
  return promised * std::max(kFastestConvergence, std::sqrt(promised / last_promised));
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
  model_.diagonal().array() += kRidge * (1 + model_.diagonal().maxCoeff());
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
  Eigen::VectorXd y = parameters->cwiseMax(lower_).cwiseMin(upper_);
  *parameters = y;
  solution.objective = std::numeric_limits<double>::infinity();
  double promised = 0, last_promised = 0;  // of the move to y, and of a full move before it
  while (solution.evaluations < options_.max_evaluations) {
    frame_.Linearize(measured_in_rig, y);
    ++solution.evaluations;
    candidate_move_.setZero(y.size());
    frame_.Build(candidate_move_, &current_);
    if (!(current_.objective <= solution.objective - kSufficientPart * promised)) {
      promised *= 0.5;
      last_promised = 0;
      solution.converged = promised <= ToleranceOf(solution.objective);
      if (solution.converged) return solution;
      move_ *= 0.5;
      y = *parameters + move_;
      continue;
    }
    *parameters = y;
    solution.objective = current_.objective;
    move_.swap(candidate_move_);
    box_lower_ = lower_ - y;
    box_upper_ = upper_ - y;
    last_promised = promised;
    promised = MinimizeLinearized(solution.evaluations == 1 ? 0 : 1);
    y = (y + move_).cwiseMax(lower_).cwiseMin(upper_);
    if (Foreseen(promised, last_promised) <= ToleranceOf(solution.objective)) {
      *parameters = y;
      solution.objective -= promised;
      solution.converged = true;
      return solution;
    }
  }
  return solution;
}

}  // namespace articap
