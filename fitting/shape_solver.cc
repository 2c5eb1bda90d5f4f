// SPDX-License-Identifier: MIT
#include "fitting/shape_solver.h"

#include <algorithm>
#include <utility>

#include "fitting/box_qp.h"

namespace articap {
namespace {

constexpr double kAbsoluteTolerance_mm = 1e-12;

// Parameters that no marker sees have no curvature; this keeps the model definite and leaves them.
constexpr double kRidge = 1e-12;

// Far from the minimum, where a step still halves the objective, Newton's model of a distance is no
// good: it has no curvature towards the marker.
constexpr double kFarDecrease = 0.3;

}  // namespace

ShapeSolver::ShapeSolver(const VirtualMarkerEvaluator& evaluator, Eigen::VectorXd lower,
                         Eigen::VectorXd upper, const ShapeSolverOptions& options)
    : builder_(evaluator, options.loss),
      lower_(std::move(lower)),
      upper_(std::move(upper)),
      options_(options) {}

// A step of the reweighted or of Newton's model, within the box.
ShapeSolver::Step ShapeSolver::SolveModel(bool newton, double damping,
                                          const Eigen::VectorXd& parameters) {
  model_ = current_.reweighted_hessian;
  if (newton) model_ += current_.loss_curvature;
  model_.diagonal() += damping * current_.reweighted_hessian.diagonal();
  model_.diagonal().array() += kRidge;
  Step step;
  step.change = SolveBoxQp(model_, current_.gradient, lower_ - parameters, upper_ - parameters);
  step.promised = -current_.gradient.dot(step.change) - 0.5 * step.change.dot(model_ * step.change);
  return step;
}

ShapeSolution ShapeSolver::Solve(MarkerPositions measured_in_rig, Eigen::VectorXd* parameters) {
  *parameters = parameters->cwiseMax(lower_).cwiseMin(upper_);
  builder_.Build(measured_in_rig, *parameters, &current_);
  ShapeSolution solution{current_.objective, 1, false};

  bool newton = false;
  double damping = 0;
  while (solution.evaluations < options_.max_evaluations) {
    const Step step = SolveModel(newton, damping, *parameters);
    if (step.promised <= options_.relative_tolerance * current_.objective + kAbsoluteTolerance_mm) {
      solution.converged = true;
      break;
    }
    const Eigen::VectorXd candidate = (*parameters + step.change).cwiseMax(lower_).cwiseMin(upper_);
    builder_.Build(measured_in_rig, candidate, &candidate_);
    ++solution.evaluations;
    const double decrease = current_.objective - candidate_.objective;
    const double gain = decrease / step.promised;
    if (decrease > 0) {
      newton = gain > 0.25 && decrease < kFarDecrease * current_.objective;
      if (gain > 0.5) damping *= 0.1;
      *parameters = candidate;
      std::swap(current_, candidate_);
    } else if (newton) {
      newton = false;
    } else {
      damping = damping > 0 ? 10 * damping : 1e-3;
      if (damping > 1e9) break;
    }
  }
  solution.objective = current_.objective;
  return solution;
}

}  // namespace articap
