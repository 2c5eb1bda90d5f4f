// SPDX-License-Identifier: MIT
#include "render/mirror_plane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace articap {
namespace {

// A ray that has just left a mirror does not meet it again.
constexpr double kLeastDistance_mm = 1e-6;

}  // namespace

MirrorPlane::MirrorPlane(const RenderMirror& mirror)
    : mirror_(mirror),
      distance_mm_(mirror.normal.dot(mirror.center_mm)),
      up_((mirror.up - mirror.normal.dot(mirror.up) * mirror.normal).normalized()),
      across_(mirror.normal.cross(up_)) {
  ARTICAP_CHECK_LT(std::abs(mirror.normal.norm() - 1), 1e-9);
  ARTICAP_CHECK_LT(std::abs(up_.norm() - 1), 1e-9);
  ARTICAP_CHECK(mirror.glass_mm >= 0 && mirror.glass_index >= 1);
}

double MirrorPlane::OutsideOf_mm(const Eigen::Vector3d& point_mm) const {
  const Eigen::Vector3d arm = point_mm - mirror_.center_mm;
  return std::max(std::abs(arm.dot(across_)) - mirror_.width_mm / 2,
                  std::abs(arm.dot(up_)) - mirror_.height_mm / 2);
}

std::optional<MirrorMeeting> MirrorPlane::Meet(const SightRay& ray) const {
  const Eigen::Vector3d& normal = mirror_.normal;
  const double cos_air = normal.dot(ray.direction);
  if (cos_air == 0) return std::nullopt;
  const bool from_behind = cos_air < 0;
  const double plane_mm = distance_mm_ - (from_behind ? 0 : mirror_.glass_mm);
  const double distance_mm = (plane_mm - normal.dot(ray.origin_mm)) / cos_air;
  if (!(distance_mm > kLeastDistance_mm)) return std::nullopt;
  const Eigen::Vector3d enters_mm = ray.origin_mm + distance_mm * ray.direction;
  // Snell's law: what lies along the surface is divided by the index.
  const Eigen::Vector3d along = (ray.direction - cos_air * normal) / mirror_.glass_index;
  const double cos_glass = std::sqrt(1 - along.squaredNorm());
  const Eigen::Vector3d through_glass_mm = mirror_.glass_mm / cos_glass * along;
  const Eigen::Vector3d silver_mm =
      from_behind ? enters_mm
                  : Eigen::Vector3d(enters_mm + through_glass_mm + mirror_.glass_mm * normal);
  const double outside_mm = OutsideOf_mm(silver_mm);
  if (outside_mm > mirror_.frame_mm) return std::nullopt;
  if (from_behind || outside_mm > 0) return MirrorMeeting{distance_mm, std::nullopt};
  return MirrorMeeting{distance_mm, SightRay{enters_mm + 2 * through_glass_mm,
                                             ray.direction - 2 * cos_air * normal}};
}

}  // namespace articap
