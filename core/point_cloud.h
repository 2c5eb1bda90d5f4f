// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera.h"
#include "core/time.h"

namespace articap {

// Which dot of which camera's picture, and by which view it is taken to be seen.
struct DotSight {
  View view;
  int dot = 0;  // index in the camera's dots at that instant

  bool operator==(const DotSight&) const = default;
};

// A marker in space that has no name yet.
struct CloudPoint {
  Eigen::Vector3d position_in_stage_mm = Eigen::Vector3d::Zero();
  // From the noise of the pixels; NaN where it is not known, as of a file of markers. What a single
  // view sees has a long one, along its ray: where on it, the labels will say.
  Eigen::Matrix3d covariance_mm2 = Eigen::Matrix3d::Constant(CameraSigmas::kUnknown);
  double residual_px = 0;        // RMS of its sights; 0 where there are less than two
  double residual_mm = 0;        // RMS of its distances from their rays
  std::vector<DotSight> sights;  // empty where read from a file of markers
  int column = -1;               // of that file; -1 where it was seen
};

// Markers in space before they have names: what reconstruction gives, or an unlabelled file holds.
// Two points of a frame may claim the same dot of the same picture where the views alone do not
// tell which is right; at most one of them is.
struct PointClouds {
  double rate_hz = 1;
  int first_frame = 1;
  SessionTime start;
  std::vector<std::vector<CloudPoint>> frames;

  int num_frames() const { return static_cast<int>(frames.size()); }
  SessionTime time(int frame) const { return TimeOfFrame(frame, rate_hz, start); }
};

}  // namespace articap
