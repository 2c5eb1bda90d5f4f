// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.h"

namespace articap {

// A line in the stage frame along which a view sees a pixel, mm.
struct StageRay {
  Eigen::Vector3d origin_mm;
  Eigen::Vector3d direction;  // unit
};

// Through mirrors the ray behind its reflection; glass is not regarded.
std::optional<StageRay> RayOf(const CameraArray& array, const View& view,
                              const Eigen::Vector2d& point_px);

// Where one view shows a point.
struct Sight {
  View view;
  Eigen::Vector2d point_px = Eigen::Vector2d::Zero();
  double sigma_px = 1;  // standard deviation of one coordinate
};

struct TriangulatedPoint {
  Eigen::Vector3d point_in_stage_mm = Eigen::Vector3d::Zero();
  // From the sights' sigmas.
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Identity();
  double rms_px = 0;
};

// The point that minimises the squared distances, over their sigmas, to where it was seen: from the
// point nearest to all rays, by Gauss and Newton's method. Nothing from fewer than two sights,
// parallel rays, or a point that one of the views could not show. R. Hartley, P. Sturm,
// "Triangulation", CVIU 68(2), 1997.
std::optional<TriangulatedPoint> Triangulate(const CameraArray& array,
                                             const std::vector<Sight>& sights);

}  // namespace articap
