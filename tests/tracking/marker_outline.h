// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/camera.h"

namespace articap {

// Whether a ray from the middle of the lens meets a marker; camera frame.
using Hits = std::function<bool(const Eigen::Vector3d& direction)>;
Hits HitsSphere(const Eigen::Vector3d& center_mm, double radius_mm);
Hits HitsDisc(const Eigen::Vector3d& center_mm, double radius_mm, const Eigen::Vector3d& normal);

// Of the area in which a picture shows a marker.
struct MarkerOutline {
  Eigen::Vector2d middle_px;
  Eigen::Matrix2d shape_px2;  // of the ellipse with the same second moments, as Dot::shape_px2
};
// Its border is sought in 720 directions from a point inside.
MarkerOutline OutlineOf(const Lens& lens, const Hits& hits, const Eigen::Vector2d& inside_px);

}  // namespace articap
