// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <algorithm>

#include "core/tracks.h"
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

// The same markers, frames and states, and positions within the tolerance; of any frame of
// reference.
MATCHER_P2(TracksNear, expected, tolerance_mm, "are the tracks within the tolerance") {
  if (arg.names() != expected.names() || arg.num_frames() != expected.num_frames()) {
    *result_listener << "which have other markers or " << arg.num_frames() << " frames";
    return false;
  }
  double worst_mm = 0;
  for (int frame = 0; frame < arg.num_frames(); ++frame)
    for (int marker = 0; marker < arg.num_markers(); ++marker) {
      const bool same_state = arg.state(frame, marker) == expected.state(frame, marker);
      const double distance_mm =
          arg.is_missing(frame, marker)
              ? 0.0
              : (arg.position_mm(frame, marker) - expected.position_mm(frame, marker)).norm();
      if (!same_state || distance_mm > tolerance_mm) {
        *result_listener << "which differ at frame " << frame << ", marker '" << arg.names()[marker]
                         << "'" << (same_state ? "" : " in their state") << " by " << distance_mm
                         << " mm";
        return false;
      }
      worst_mm = std::max(worst_mm, distance_mm);
    }
  *result_listener << "which differ by up to " << worst_mm << " mm";
  return true;
}

}  // namespace articap
