// SPDX-License-Identifier: MIT
#include "tracking/perspective_bias.h"

#include <Eigen/Geometry>

namespace articap {
namespace {

Eigen::Matrix3d DualConicOfSphere(const Eigen::Vector3d& center_mm, double radius_mm) {
  const Eigen::Vector3d direction = center_mm.normalized();
  const double sine = radius_mm / center_mm.norm();
  return direction * direction.transpose() - sine * sine * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d DualConicOfDisc(const Eigen::Vector3d& center_mm, double radius_mm,
                                const Eigen::Vector3d& normal) {
  const Eigen::Vector3d a = normal.unitOrthogonal(), b = normal.normalized().cross(a);
  return center_mm * center_mm.transpose() -
         radius_mm * radius_mm * (a * a.transpose() + b * b.transpose());
}

}  // namespace

std::optional<Eigen::Vector2d> PerspectiveBias(const Lens& lens,
                                               const Eigen::Vector3d& center_in_cam_mm,
                                               const MarkerForm& marker) {
  const double radius_mm = marker.diameter_mm / 2;
  if (!Project(lens, center_in_cam_mm)) return std::nullopt;
  const Eigen::Vector3d normal = marker.normal_in_cam.value_or(center_in_cam_mm);
  const Eigen::Matrix3d dual = marker.kind == MarkerKind::kSphere
                                   ? DualConicOfSphere(center_in_cam_mm, radius_mm)
                                   : DualConicOfDisc(center_in_cam_mm, radius_mm, normal);
  // The outline is an ellipse as long as it does not reach the plane of the camera.
  if (!(dual(2, 2) > 0)) return std::nullopt;
  const Eigen::Vector2d middle = dual.col(2).head<2>() / dual(2, 2);
  const Eigen::Vector2d center = center_in_cam_mm.hnormalized();
  const Eigen::Vector2d focal_px(lens.fx_px, lens.fy_px);
  return focal_px.asDiagonal() *
         (DistortJacobian(lens.distortion.data(), center) * (middle - center));
}

}  // namespace articap
