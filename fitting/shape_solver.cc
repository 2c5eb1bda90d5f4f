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
constexpr double kFarDecrease = 0.1;

constexpr double kFirstDamping = 0.2;
constexpr double kMostDamping = 1e9;

}  // namespace

ShapeSolver::ShapeSolver(const VirtualMarkerEvaluator& evaluator, Eigen::VectorXd lower,
                         Eigen::VectorXd upper, const ShapeSolverOptions& options)
    : builder_(evaluator, options.loss),
      lower_(std::move(lower)),
      upper_(std::move(upper)),
      options_(options) {}

// A step within the box. `damping` leads from Newton's model (0) to one that is at least the
// reweighted one (1) and therefore safe.
ShapeSolver::Step ShapeSolver::SolveModel(bool far, double damping,
                                          const Eigen::VectorXd& parameters) {
  model_ = current_.reweighted_hessian * (1 + damping);
  if (!far) model_ += current_.loss_curvature;
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

  bool far = true;
  double damping = 0;
  while (solution.evaluations < options_.max_evaluations) {
    const Step step = SolveModel(far, damping, *parameters);
    if (step.promised <= options_.relative_tolerance * current_.objective + kAbsoluteTolerance_mm) {
      solution.converged = true;
      break;
    }
    const Eigen::VectorXd candidate = (*parameters + step.change).cwiseMax(lower_).cwiseMin(upper_);
    builder_.Build(measured_in_rig, candidate, &candidate_);
    ++solution.evaluations;
    const double decrease = current_.objective - candidate_.objective;
    const double gain = decrease / step.promised;
    if (gain < 0.25) damping = std::max(kFirstDamping, 5 * damping);
    if (gain > 0.75) damping = damping > kFirstDamping ? 0.2 * damping : 0;
    if (damping > kMostDamping) break;
    if (decrease > 0) {
      far = decrease > kFarDecrease * current_.objective;
      *parameters = candidate;
      std::swap(current_, candidate_);
    }
  }
  solution.objective = current_.objective;
  return solution;
}

}  // namespace articap
