// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/transforms.h"
#include "rig/face_rig.h"

namespace articap {

// A measured point and the landmark of the rig that it sits at, so high above the skin.
struct LandmarkPoint {
  int vertex = 0;
  Eigen::Vector3d point_in_head = Eigen::Vector3d::Zero();
  double height_mm = 0;
};

// The identity sliders that bring a rig's landmarks nearest to measured points, with the seven
// parameters of the similarity left free: Huber loss (markers sit beside their landmarks now and
// then) plus a prior that pulls every slider to 0 with a standard deviation of half its range, for
// what the markers do not tell. Sliders stay within their ranges; those of `given` are held there.
Eigen::VectorXd FitIdentity(const FaceRig& rig, const Eigen::VectorXd& pose,
                            std::span<const LandmarkPoint> points, const Sim3d& rig_from_head,
                            const std::vector<std::optional<double>>& given);

}  // namespace articap
