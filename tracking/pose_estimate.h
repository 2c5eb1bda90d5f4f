// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/point_cloud.h"
#include "core/transforms.h"
#include "tracking/marker_place.h"

namespace articap {

// A small rotation vector (rad) about a center, and how far the center is then shifted (mm).
using PoseChange = Eigen::Matrix<double, 6, 1>;

// A pose of the head, and what it may be off.
struct PoseEstimate {
  Rigid3d template_from_stage;
  Eigen::Vector3d center_mm;               // in the template; where a head turns, about
  Eigen::Matrix<double, 6, 6> covariance;  // of the PoseChange that leads to the true pose

  // A pose off by these SDs in every direction.
  static PoseEstimate Isotropic(const Rigid3d& template_from_stage,
                                const Eigen::Vector3d& center_mm, double rotation_sigma_rad,
                                double translation_sigma_mm);
  // Of a place in the template that the pose brought there.
  Eigen::Matrix3d CovarianceAt_mm2(const Eigen::Vector3d& place_mm) const;
};

Rigid3d Changed(const Rigid3d& pose, const Eigen::Vector3d& center_mm, const PoseChange& change);
// The change that leads from `from` to `to`.
PoseChange ChangeBetween(const Rigid3d& from, const Rigid3d& to, const Eigen::Vector3d& center_mm);

Eigen::Vector3d MiddleOf(std::span<const MarkerPlace> markers);

// Of a point; 0.2 mm a coordinate where a file does not say how well it was measured.
Eigen::Matrix3d CovarianceOf_mm2(const CloudPoint& point);  // in the stage
Eigen::Matrix3d CovarianceInTemplate_mm2(const CloudPoint& point,
                                         const Rigid3d& template_from_stage);

// The pose of the greatest posterior density: each labelled point by its own covariance, so that
// what a single view sees counts across its ray, and each marker by how well its place is known. By
// Gauss and Newton's method from the prior. `points`: by marker, an index in the cloud or -1.
PoseEstimate PoseOf(std::span<const MarkerPlace> markers, std::span<const CloudPoint> cloud,
                    const std::vector<int>& points, const PoseEstimate& prior);

}  // namespace articap
