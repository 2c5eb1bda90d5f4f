// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/autodiff_cost_function.h>

#include <Eigen/Core>
#include <cmath>

#include "calib/mirror_rays.h"

namespace articap {

// What a nominal camera and its mirror are described by: the logarithm of the focal length in px,
// the angle between the mirror's plane and the camera's axis, and how far the mirror is tilted from
// upright, rad.
enum NominalParameter { kLogFocal, kMirrorAngle, kMirrorTilt, kNumNominal };

// Camera frame, away from the camera. `side`: 1 for a mirror on the right of the picture, -1 on its
// left.
template <class T>
Eigen::Matrix<T, 3, 1> NominalNormal(const T* parameters, double side) {
  using std::cos;
  using std::sin;
  const T upright = cos(parameters[kMirrorTilt]);
  return {side * cos(parameters[kMirrorAngle]) * upright, sin(parameters[kMirrorTilt]),
          sin(parameters[kMirrorAngle]) * upright};
}

// Sampson's distance of a dot and its reflection, both from the middle of the picture, over its
// standard deviation. Parameters: NominalParameter.
struct MirrorDirectionCost {
  Eigen::Vector2d direct_px;
  Eigen::Vector2d mirrored_px;
  double side;
  double sigma_px;

  template <class T>
  bool operator()(const T* parameters, T* residual) const {
    using std::exp;
    const T focal_px = exp(parameters[kLogFocal]);
    const Eigen::Matrix<T, 3, 1> direct(direct_px.x() / focal_px, direct_px.y() / focal_px, T(1));
    const Eigen::Matrix<T, 3, 1> mirrored(mirrored_px.x() / focal_px, mirrored_px.y() / focal_px,
                                          T(1));
    residual[0] =
        SampsonDistance_px<T>(direct, mirrored, NominalNormal(parameters, side), focal_px) /
        sigma_px;
    return true;
  }

  static ceres::CostFunction* Create(const Eigen::Vector2d& direct_px,
                                     const Eigen::Vector2d& mirrored_px, double side,
                                     double sigma_px) {
    return new ceres::AutoDiffCostFunction<MirrorDirectionCost, 1, kNumNominal>(
        new MirrorDirectionCost{direct_px, mirrored_px, side, sigma_px});
  }
};

}  // namespace articap
