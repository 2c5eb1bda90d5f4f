// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "render/scene.h"
#include "render/view_camera.h"

namespace articap {

// Where a ray of sight meets a mirror.
struct MirrorMeeting {
  double distance_mm = 0;  // along the ray, to the mirror's front
  // How the ray goes on; nothing where it ends, on the frame or the back.
  std::optional<SightRay> reflected;
};

// A mirror made ready for rays.
class MirrorPlane {
 public:
  explicit MirrorPlane(const RenderMirror& mirror);

  std::optional<MirrorMeeting> Meet(const SightRay& ray) const;

 private:
  // How far a point of the plane lies outside the rectangle, mm; negative inside.
  double OutsideOf_mm(const Eigen::Vector3d& point_mm) const;

  RenderMirror mirror_;
  double distance_mm_;  // of the reflecting plane from the origin, along the normal
  Eigen::Vector3d up_;
  Eigen::Vector3d across_;
};

}  // namespace articap
