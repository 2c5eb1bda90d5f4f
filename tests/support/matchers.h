// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>

#include <Eigen/Core>

#include "core/transforms.h"

namespace articap {

MATCHER_P2(PointNear, point, tolerance_mm, "is the point within the tolerance") {
  const double distance = (Eigen::Vector3d(arg) - Eigen::Vector3d(point)).norm();
  *result_listener << "which is " << distance << " mm away";
  return distance <= tolerance_mm;
}

MATCHER_P3(Rigid3dNear, expected, tolerance_rad, tolerance_mm,
           "is the rigid transform within the tolerances") {
  const double angle = expected.rotation.angularDistance(arg.rotation);
  const double distance = (expected.translation_mm - arg.translation_mm).norm();
  *result_listener << "which is turned by " << angle << " rad and moved by " << distance << " mm";
  return angle <= tolerance_rad && distance <= tolerance_mm;
}

MATCHER_P4(Sim3dNear, expected, tolerance_rad, tolerance_mm, tolerance_scale,
           "is the similarity within the tolerances") {
  const double angle = expected.rotation.angularDistance(arg.rotation);
  const double distance = (expected.translation_mm - arg.translation_mm).norm();
  const double scale = std::abs(arg.scale / expected.scale - 1);
  *result_listener << "which is turned by " << angle << " rad, moved by " << distance
                   << " mm, scaled by 1 + " << scale;
  return angle <= tolerance_rad && distance <= tolerance_mm && scale <= tolerance_scale;
}

}  // namespace articap
