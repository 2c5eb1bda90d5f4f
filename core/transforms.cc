// SPDX-License-Identifier: MIT
#include "core/transforms.h"

#include <algorithm>
#include <cmath>

namespace articap {

Sim3d Sim3d::FromParameters(const std::array<double, 7>& x) {
  const auto [tx, ty, tz, ax, ay, az, s] = x;
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(az, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(ay, Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(ax, Eigen::Vector3d::UnitX());
  return {s, rotation, {tx, ty, tz}};
}

std::array<double, 7> Sim3d::ToParameters() const {
  // R = Rz Ry Rx: R(2,0) = -sin ay, R(2,1) = cos ay sin ax, R(1,0) = cos ay sin az.
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  const double ay = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  // At ay = +-90 degrees only ax -+ az is determined; az is then taken as 0.
  const bool gimbal_lock = std::hypot(r(2, 1), r(2, 2)) < 1e-12;
  const double ax = gimbal_lock ? std::atan2(-r(1, 2), r(1, 1)) : std::atan2(r(2, 1), r(2, 2));
  const double az = gimbal_lock ? 0.0 : std::atan2(r(1, 0), r(0, 0));
  return {translation_mm.x(), translation_mm.y(), translation_mm.z(), ax, ay, az, scale};
}

}  // namespace articap
