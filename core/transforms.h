// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace articap {

// Transforms are named target_from_source, and names meet in a product:
//   point_in_head = head_from_stage * point_in_stage;  a_from_c = a_from_b * b_from_c.

// x_in_target = rotation * x_in_source + translation_mm.
struct Rigid3d {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation_mm;
  }
  Rigid3d operator*(const Rigid3d& right) const {
    return {(rotation * right.rotation).normalized(),
            rotation * right.translation_mm + translation_mm};
  }
  Rigid3d Inverse() const {
    const Eigen::Quaterniond inverse = rotation.conjugate();
    return {inverse, -(inverse * translation_mm)};
  }
};

// x_in_target = scale * rotation * x_in_source + translation_mm, scale > 0: never a reflection.
struct Sim3d {
  double scale = 1;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return scale * (rotation * point) + translation_mm;
  }
  Sim3d operator*(const Sim3d& right) const {
    return {scale * right.scale, (rotation * right.rotation).normalized(),
            scale * (rotation * right.translation_mm) + translation_mm};
  }
  Sim3d Inverse() const {
    const Eigen::Quaterniond inverse = rotation.conjugate();
    return {1 / scale, inverse, -(inverse * translation_mm) / scale};
  }

  // The seven parameters of Beskow's orientation fit, x = (tx, ty, tz, ax, ay, az, s): translation
  // in mm, angles in rad, R = Rz(az) Ry(ay) Rx(ax), scale.
  static Sim3d FromParameters(const std::array<double, 7>& x);
  std::array<double, 7> ToParameters() const;
};

}  // namespace articap
