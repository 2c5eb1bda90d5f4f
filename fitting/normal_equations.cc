// SPDX-License-Identifier: MIT
#include "fitting/normal_equations.h"

#include <algorithm>

namespace articap {

NormalEquationBuilder::NormalEquationBuilder(const VirtualMarkerEvaluator& evaluator,
                                             const MarkerLoss& loss)
    : evaluator_(evaluator),
      loss_(loss),
      jacobian_(3 * evaluator.num_parameters()),
      slopes_(evaluator.num_parameters()) {}

void NormalEquationBuilder::Build(MarkerPositions measured_in_rig,
                                  const Eigen::VectorXd& parameters, NormalEquations* equations) {
  const int num_parameters = evaluator_.num_parameters();
  equations->objective = 0;
  equations->gradient.setZero(num_parameters);
  equations->reweighted_hessian.setZero(num_parameters, num_parameters);
  equations->loss_curvature.setZero(num_parameters, num_parameters);
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(num_parameters)});
  for (int i = 0; i < evaluator_.num_markers(); ++i) {
    const Eigen::Vector3d& measured = measured_in_rig[i];
    if (measured.x() != measured.x()) continue;  // NaN: missing
    const Eigen::Vector3d residual =
        evaluator_.PositionAndJacobian(pose, i, jacobian_.data()) - measured;
    const MarkerLoss::Value loss = loss_(residual.squaredNorm());
    equations->objective += loss.cost;
    AddMarker(i, residual, 2 * loss.first, 4 * loss.second, equations);
  }
  equations->reweighted_hessian.triangularView<Eigen::StrictlyUpper>() =
      equations->reweighted_hessian.transpose();
  equations->loss_curvature.triangularView<Eigen::StrictlyUpper>() =
      equations->loss_curvature.transpose();
}

// Adds one marker to the gradient and to the lower triangles.
void NormalEquationBuilder::AddMarker(int marker, const Eigen::Vector3d& residual, double weight,
                                      double curvature, NormalEquations* equations) {
  const int num_parameters = evaluator_.num_parameters();
  const auto columns = evaluator_.active_parameters(marker);
  const int num_columns = static_cast<int>(columns.size());
  double* const hessian = equations->reweighted_hessian.data();
  double* const curvature_sum = equations->loss_curvature.data();
  for (int a = 0; a < num_columns; ++a) {
    const double* const j = jacobian_.data() + 3 * a;
    slopes_[a] = j[0] * residual[0] + j[1] * residual[1] + j[2] * residual[2];
    equations->gradient[columns[a]] += weight * slopes_[a];
  }
  for (int b = 0; b < num_columns; ++b) {
    const double* const j_b = jacobian_.data() + 3 * b;
    const double x = weight * j_b[0], y = weight * j_b[1], z = weight * j_b[2];
    const double curved_slope = curvature * slopes_[b];
    for (int a = b; a < num_columns; ++a) {
      const double* const j_a = jacobian_.data() + 3 * a;
      const auto [first, second] = std::minmax(columns[a], columns[b]);
      const int lower_entry = first * num_parameters + second;
      hessian[lower_entry] += x * j_a[0] + y * j_a[1] + z * j_a[2];
      curvature_sum[lower_entry] += curved_slope * slopes_[a];
    }
  }
}

double NormalEquationBuilder::Objective(MarkerPositions measured_in_rig,
                                        const Eigen::VectorXd& parameters) const {
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(evaluator_.num_parameters())});
  double objective = 0;
  for (int i = 0; i < evaluator_.num_markers(); ++i) {
    const Eigen::Vector3d& measured = measured_in_rig[i];
    if (measured.x() != measured.x()) continue;
    objective += loss_((evaluator_.Position(pose, i) - measured).squaredNorm()).cost;
  }
  return objective;
}

}  // namespace articap
