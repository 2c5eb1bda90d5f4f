// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "rig/virtual_marker_evaluator.h"

namespace articap {

// Residual of one marker, 3 numbers, mm: q(y) - p. One parameter block: all parameters of the rig,
// y. Not templated: the evaluator's Jacobian is analytic.
class VirtualMarkerCost : public ceres::CostFunction {
 public:
  VirtualMarkerCost(const VirtualMarkerEvaluator& evaluator, int marker,
                    const Eigen::Vector3d& measured_in_rig)
      : evaluator_(evaluator), marker_(marker), measured_in_rig_(measured_in_rig) {
    set_num_residuals(3);
    mutable_parameter_block_sizes()->push_back(evaluator.num_parameters());
  }

  static ceres::CostFunction* Create(const VirtualMarkerEvaluator& evaluator, int marker,
                                     const Eigen::Vector3d& measured_in_rig) {
    return new VirtualMarkerCost(evaluator, marker, measured_in_rig);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const std::size_t num_parameters = static_cast<std::size_t>(evaluator_.num_parameters());
    const auto pose = evaluator_.PoseOf({parameters[0], num_parameters});
    Eigen::Map<Eigen::Vector3d> residual(residuals);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      residual = evaluator_.Position(pose, marker_) - measured_in_rig_;
      return true;
    }
    std::vector<double> columns(3 * num_parameters);
    residual = evaluator_.PositionAndJacobian(pose, marker_, columns.data()) - measured_in_rig_;
    Eigen::Map<Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        jacobians[0], 3, evaluator_.num_parameters());
    jacobian.setZero();
    const auto active = evaluator_.active_parameters(marker_);
    for (std::size_t k = 0; k < active.size(); ++k)
      jacobian.col(active[k]) = Eigen::Map<const Eigen::Vector3d>(columns.data() + 3 * k);
    return true;
  }

 private:
  const VirtualMarkerEvaluator& evaluator_;
  int marker_;
  Eigen::Vector3d measured_in_rig_;
};

}  // namespace articap
