// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/camera.h"

namespace articap {

enum class MarkerKind : std::uint8_t { kDisc, kSphere };

struct MarkerForm {
  MarkerKind kind = MarkerKind::kDisc;
  double diameter_mm = 3;
  // Of a disc, unit or not, either way, camera frame; not known: it faces the camera.
  std::optional<Eigen::Vector3d> normal_in_cam;
};

// Where the middle of a marker's ellipse (Dot::center_px) lies, from where the marker's own centre
// appears; px. To be subtracted from what was measured. Perspective shows the near half larger: by
// 0.2 px for a disc of 10 mm at 300 mm that is turned by 45 degrees, with a focal length of 1500
// px.
//
// Without distortion this is exact. The dual conic of the outline, Q*, is
//   sphere: u u^T - (radius / distance)^2 I, with u the direction to the centre (tangent cone);
//   disc:   H diag(1, 1, -1) H^T, with H = [radius a, radius b, centre] and a, b unit in its plane;
// and the middle is the pole of the line at infinity, Q* (0, 0, 1)^T. (Hartley and Zisserman,
// Multiple View Geometry, 2nd ed., 2.2.3 and 8.3; J. Heikkila, "Geometric camera calibration using
// circular control points", PAMI 22(10), 2000.) A lens that distorts bends the outline: its middle
// is then that of the area within, from points of the outline.
//
// Nothing where not all of the marker is ahead of the camera.
std::optional<Eigen::Vector2d> PerspectiveBias(const Lens& lens,
                                               const Eigen::Vector3d& center_in_cam_mm,
                                               const MarkerForm& marker);

}  // namespace articap
