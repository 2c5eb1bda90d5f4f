// SPDX-License-Identifier: MIT
#include "tracking/perspective_bias.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

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

// Without distortion the polygon is one of an ellipse, and its middle exact; what a smooth lens
// changes of that falls with the fourth power of their number.
constexpr int kOutlinePoints = 32;

// Of the area.
Eigen::Vector2d MiddleOfPolygon(const std::array<Eigen::Vector2d, kOutlinePoints>& corners) {
  double area = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < kOutlinePoints; ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % kOutlinePoints];
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross;
    sum += cross * (a + b) / 3;
  }
  return sum / area;
}

}  // namespace

std::optional<Eigen::Vector2d> PerspectiveBias(const Lens& lens,
                                               const Eigen::Vector3d& center_in_cam_mm,
                                               const MarkerForm& marker) {
  const double radius_mm = marker.diameter_mm / 2;
  const auto center_px = Project(lens, center_in_cam_mm);
  if (!center_px) return std::nullopt;
  const Eigen::Vector3d normal = marker.normal_in_cam.value_or(center_in_cam_mm);
  const Eigen::Matrix3d dual = marker.kind == MarkerKind::kSphere
                                   ? DualConicOfSphere(center_in_cam_mm, radius_mm)
                                   : DualConicOfDisc(center_in_cam_mm, radius_mm, normal);
  // The outline is an ellipse as long as it does not reach the plane of the camera.
  if (!(dual(2, 2) > 0)) return std::nullopt;
  const Eigen::Vector2d middle = dual.col(2).head<2>() / dual(2, 2);
  // Of the ellipse, in the plane at distance 1: its points p have (p - middle)^T shape^-1 (p -
  // middle) = 1.
  const Eigen::Matrix2d shape =
      middle * middle.transpose() - dual.topLeftCorner<2, 2>() / dual(2, 2);
  const Eigen::LLT<Eigen::Matrix2d> root(shape);
  if (root.info() != Eigen::Success) return std::nullopt;
  std::array<Eigen::Vector2d, kOutlinePoints> outline;
  for (int i = 0; i < kOutlinePoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kOutlinePoints;
    const Eigen::Vector2d point =
        middle + root.matrixL() * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const auto appears = Project(lens, point.homogeneous());
    if (!appears) return std::nullopt;
    outline[i] = *appears - *center_px;
  }
  return MiddleOfPolygon(outline);
}

}  // namespace articap
