// SPDX-License-Identifier: MIT
#include "fitting/normal_equations.h"

#include <algorithm>

namespace articap {
namespace {

bool IsSeen(const Eigen::Vector3d& measured) { return measured.x() == measured.x(); }  // not NaN

}  // namespace

LinearizedFrame::LinearizedFrame(const VirtualMarkerEvaluator& evaluator, const MarkerLoss& loss)
    : evaluator_(evaluator), loss_(loss), slopes_(evaluator.num_parameters()) {
  std::size_t size = 0;
  for (int i = 0; i < evaluator.num_markers(); ++i)
    size += 3 * evaluator.active_parameters(i).size();
  jacobians_.resize(size);
  seen_.reserve(evaluator.num_markers());
}

void LinearizedFrame::Linearize(MarkerPositions measured_in_rig,
                                const Eigen::VectorXd& parameters) {
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(evaluator_.num_parameters())});
  seen_.clear();
  std::size_t first = 0;
  for (int i = 0; i < evaluator_.num_markers(); ++i) {
    if (!IsSeen(measured_in_rig[i])) continue;
    const auto columns = evaluator_.active_parameters(i);
    const Eigen::Vector3d position =
        evaluator_.PositionAndJacobian(pose, i, jacobians_.data() + first);
    seen_.push_back({columns, position - measured_in_rig[i], first});
    first += 3 * columns.size();
  }
}

void LinearizedFrame::Build(const Eigen::VectorXd& d, NormalEquations* equations) {
  const int num_parameters = evaluator_.num_parameters();
  equations->objective = 0;
  equations->gradient.setZero(num_parameters);
  equations->reweighted_hessian.setZero(num_parameters, num_parameters);
  equations->loss_curvature.setZero(num_parameters, num_parameters);
  for (const Marker& marker : seen_) {
    Eigen::Vector3d residual = marker.residual;
    const double* j = jacobians_.data() + marker.first;
    for (const int column : marker.columns) {
      residual += d[column] * Eigen::Map<const Eigen::Vector3d>(j);
      j += 3;
    }
    const MarkerLoss::Value loss = loss_(residual.squaredNorm());
    equations->objective += loss.cost;
    AddMarker(marker, residual, 2 * loss.first, 4 * loss.second, equations);
  }
  equations->reweighted_hessian.triangularView<Eigen::StrictlyUpper>() =
      equations->reweighted_hessian.transpose();
  equations->loss_curvature.triangularView<Eigen::StrictlyUpper>() =
      equations->loss_curvature.transpose();
}

// Adds one marker to the gradient and to the lower triangles.
void LinearizedFrame::AddMarker(const Marker& marker, const Eigen::Vector3d& residual,
                                double weight, double curvature, NormalEquations* equations) {
  const int num_parameters = evaluator_.num_parameters();
  const double* const jacobian = jacobians_.data() + marker.first;
  const auto columns = marker.columns;
  const int num_columns = static_cast<int>(columns.size());
  double* const hessian = equations->reweighted_hessian.data();
  double* const curvature_sum = equations->loss_curvature.data();
  for (int a = 0; a < num_columns; ++a) {
    const double* const j = jacobian + 3 * a;
    slopes_[a] = j[0] * residual[0] + j[1] * residual[1] + j[2] * residual[2];
    equations->gradient[columns[a]] += weight * slopes_[a];
  }
  for (int b = 0; b < num_columns; ++b) {
    const double* const j_b = jacobian + 3 * b;
    const double x = weight * j_b[0], y = weight * j_b[1], z = weight * j_b[2];
    const double curved_slope = curvature * slopes_[b];
    for (int a = b; a < num_columns; ++a) {
      const double* const j_a = jacobian + 3 * a;
      const auto [first, second] = std::minmax(columns[a], columns[b]);
      const int lower_entry = first * num_parameters + second;
      hessian[lower_entry] += x * j_a[0] + y * j_a[1] + z * j_a[2];
      curvature_sum[lower_entry] += curved_slope * slopes_[a];
    }
  }
}

double LinearizedFrame::Objective(MarkerPositions measured_in_rig,
                                  const Eigen::VectorXd& parameters) const {
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(evaluator_.num_parameters())});
  double objective = 0;
  for (int i = 0; i < evaluator_.num_markers(); ++i)
    if (IsSeen(measured_in_rig[i]))
      objective += loss_((evaluator_.Position(pose, i) - measured_in_rig[i]).squaredNorm()).cost;
  return objective;
}

}  // namespace articap
