// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/tracks.h"

namespace articap {

// The mean shape of a take's markers, the movement of the head taken out without knowing which of
// them sit on the skull, and how much each moves within that shape.
struct MarkerMotion {
  struct Marker {
    std::string name;
    Eigen::Vector3d point_in_stage_mm = Eigen::Vector3d::Zero();  // where the head is in one frame
    double motion_mm = 0;  // root mean square distance from there; 0 for a take of one frame
  };
  std::vector<Marker> markers;
  std::vector<std::string> left_out;  // markers seen in less than half of the frames
};

// Looks at up to `max_frames` frames, evenly spread. Every marker weighs the less the more it
// moves, so that those on bone end up holding the shape.
MarkerMotion MeasureMarkerMotion(const StageTracks& tracks, int max_frames = 400);

}  // namespace articap
