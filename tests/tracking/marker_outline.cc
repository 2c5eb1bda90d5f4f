// SPDX-License-Identifier: MIT
#include "tests/tracking/marker_outline.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

namespace articap {

Hits HitsSphere(const Eigen::Vector3d& center_mm, double radius_mm) {
  return [=](const Eigen::Vector3d& direction) {
    return direction.normalized().cross(center_mm).norm() < radius_mm;
  };
}

Hits HitsDisc(const Eigen::Vector3d& center_mm, double radius_mm, const Eigen::Vector3d& normal) {
  return [=](const Eigen::Vector3d& direction) {
    const double distance = normal.dot(center_mm) / normal.dot(direction);
    return distance > 0 && (distance * direction - center_mm).norm() < radius_mm;
  };
}

MarkerOutline OutlineOf(const Lens& lens, const Hits& hits, const Eigen::Vector2d& inside_px) {
  constexpr int kDirections = 720;
  std::vector<Eigen::Vector2d> border;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double near_px = 0, far_px = 500;
    for (int step = 0; step < 60; ++step) {
      const double middle_px = (near_px + far_px) / 2;
      const auto ray = Unproject(lens, inside_px + middle_px * direction);
      (ray && hits(*ray) ? near_px : far_px) = middle_px;
    }
    border.push_back(near_px * direction);
  }
  // Moments of the polygon's area, triangle by triangle.
  double area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Eigen::Vector2d& a = border[i];
    const Eigen::Vector2d& b = border[(i + 1) % border.size()];
    const double twice = a.x() * b.y() - a.y() * b.x();
    area += twice / 2;
    first += twice / 6 * (a + b);
    second += twice / 24 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  const Eigen::Vector2d middle = first / area;
  // The second moment of an ellipse is a quarter of its squared radius.
  return {inside_px + middle, 4 * (second / area - middle * middle.transpose())};
}

}  // namespace articap
