// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include <Eigen/Core>

namespace articap {

// Residual of one strategic point under rig_from_head, 3 numbers, mm of the rig:
//   s R p_head + t - p_rig.
// Parameter blocks: [0] quaternion of R (w, x, y, z), 4; [1] t, 3, mm; [2] ln s, 1, so that the
// scale stays positive.
class SimilarityCost {
 public:
  SimilarityCost(const Eigen::Vector3d& point_in_head, const Eigen::Vector3d& point_in_rig)
      : point_in_head_(point_in_head), point_in_rig_(point_in_rig) {}

  static ceres::CostFunction* Create(const Eigen::Vector3d& point_in_head,
                                     const Eigen::Vector3d& point_in_rig) {
    return new ceres::AutoDiffCostFunction<SimilarityCost, 3, 4, 3, 1>(
        new SimilarityCost(point_in_head, point_in_rig));
  }

  template <class T>
  bool operator()(const T* rotation, const T* translation, const T* log_scale, T* residual) const {
    const T point[3] = {T(point_in_head_[0]), T(point_in_head_[1]), T(point_in_head_[2])};
    T turned[3];
    ceres::UnitQuaternionRotatePoint(rotation, point, turned);
    using std::exp;
    const T scale = exp(log_scale[0]);
    for (int axis = 0; axis < 3; ++axis)
      residual[axis] = scale * turned[axis] + translation[axis] - point_in_rig_[axis];
    return true;
  }

 private:
  Eigen::Vector3d point_in_head_, point_in_rig_;
};

}  // namespace articap
