// SPDX-License-Identifier: MIT
#include "fitting/ceres_shape_solver.h"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>

#include "fitting/cost_functions/ceres_marker_loss.h"
#include "fitting/cost_functions/virtual_marker_cost.h"

namespace articap {
namespace {

// Ceres projects steps onto bounds and may stop there short of the minimum. Parameters that rest at
// a bound with the objective falling outwards are therefore held, the others solved for, until the
// set of those held no longer changes.
std::vector<int> AtRest(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                        const Eigen::VectorXd& parameters, const Eigen::VectorXd& gradient) {
  std::vector<int> held;
  for (int i = 0; i < lower.size(); ++i)
    if ((parameters[i] <= lower[i] && gradient[i] >= 0) ||
        (parameters[i] >= upper[i] && gradient[i] <= 0))
      held.push_back(i);
  return held;
}

ceres::Solver::Options TightOptions() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 1000;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-13;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

ShapeSolution SolveShapeWithCeres(const VirtualMarkerEvaluator& evaluator,
                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                  const MarkerLoss& loss, MarkerPositions measured_in_rig,
                                  Eigen::VectorXd* parameters) {
  const int num_parameters = evaluator.num_parameters();
  *parameters = parameters->cwiseMax(lower).cwiseMin(upper);
  CeresMarkerLoss ceres_loss(loss);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  problem.AddParameterBlock(parameters->data(), num_parameters);
  for (int i = 0; i < evaluator.num_markers(); ++i)
    if (measured_in_rig[i].allFinite())
      problem.AddResidualBlock(VirtualMarkerCost::Create(evaluator, i, measured_in_rig[i]),
                               &ceres_loss, parameters->data());
  for (int i = 0; i < num_parameters; ++i)
    if (lower[i] < upper[i]) {
      problem.SetParameterLowerBound(parameters->data(), i, lower[i]);
      problem.SetParameterUpperBound(parameters->data(), i, upper[i]);
    }

  ShapeSolution solution;
  std::vector<int> held;
  Eigen::VectorXd gradient(num_parameters);
  for (int round = 0; round < 4 * num_parameters && !solution.converged; ++round) {
    problem.SetManifold(parameters->data(), nullptr);
    problem.SetParameterBlockVariable(parameters->data());
    double* const values = parameters->data();
    std::vector<double> slopes;
    problem.Evaluate({}, &solution.objective, nullptr, &slopes, nullptr);
    gradient = Eigen::Map<Eigen::VectorXd>(slopes.data(), num_parameters);
    const std::vector<int> at_rest = AtRest(lower, upper, *parameters, gradient);
    solution.converged = round > 0 && at_rest == held;
    if (solution.converged || static_cast<int>(at_rest.size()) == num_parameters) {
      solution.converged = true;
      break;
    }
    held = at_rest;
    if (!held.empty()) problem.SetManifold(values, new ceres::SubsetManifold(num_parameters, held));
    ceres::Solver::Summary summary;
    ceres::Solve(TightOptions(), &problem, &summary);
    solution.evaluations += summary.num_residual_evaluations;
  }
  return solution;
}

}  // namespace articap
