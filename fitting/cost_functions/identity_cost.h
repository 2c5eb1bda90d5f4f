// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/rotation.h>

#include <Eigen/Core>

namespace articap {

// Residual of one landmark whose place on the rig depends on the identity, 3 numbers, mm of the
// rig:
//   s R p_head + t - (l + D identity).
// Parameter blocks: [0] quaternion of R (w, x, y, z), 4; [1] t, 3, mm; [2] ln s, 1; [3] identity
// sliders, as many as D has columns.
class IdentityCost {
 public:
  // `landmark_in_rig`: l, at identity 0; `displacements`: D, mm per unit of each slider.
  IdentityCost(const Eigen::Vector3d& point_in_head, const Eigen::Vector3d& landmark_in_rig,
               const Eigen::Matrix3Xd& displacements)
      : point_in_head_(point_in_head),
        landmark_in_rig_(landmark_in_rig),
        displacements_(displacements) {}

  static ceres::CostFunction* Create(const Eigen::Vector3d& point_in_head,
                                     const Eigen::Vector3d& landmark_in_rig,
                                     const Eigen::Matrix3Xd& displacements) {
    auto* const cost = new ceres::DynamicAutoDiffCostFunction<IdentityCost>(
        new IdentityCost(point_in_head, landmark_in_rig, displacements));
    for (const int size : {4, 3, 1, static_cast<int>(displacements.cols())})
      cost->AddParameterBlock(size);
    cost->SetNumResiduals(3);
    return cost;
  }

  template <class T>
  bool operator()(T const* const* parameters, T* residual) const {
    const T point[3] = {T(point_in_head_[0]), T(point_in_head_[1]), T(point_in_head_[2])};
    T turned[3];
    ceres::UnitQuaternionRotatePoint(parameters[0], point, turned);
    using std::exp;
    const T scale = exp(parameters[2][0]);
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = scale * turned[axis] + parameters[1][axis] - landmark_in_rig_[axis];
      for (int k = 0; k < displacements_.cols(); ++k)
        residual[axis] -= displacements_(axis, k) * parameters[3][k];
    }
    return true;
  }

 private:
  Eigen::Vector3d point_in_head_, landmark_in_rig_;
  Eigen::Matrix3Xd displacements_;
};

}  // namespace articap
