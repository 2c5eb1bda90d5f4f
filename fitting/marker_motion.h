// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/tracks.h"

namespace articap {

// The shape of a take's markers while the mouth is shut, the movement of the head taken out without
// knowing which of them sit on the skull, and how much each moves within the head.
struct MarkerMotion {
  struct Marker {
    std::string name;
    Eigen::Vector3d point_in_stage_mm =
        Eigen::Vector3d::Zero();  // in the stage frame, head where it is in one frame
    double motion_mm = 0;         // root mean square distance from its mean; 0 for one frame
  };
  std::vector<Marker> markers;
  std::vector<std::string> left_out;  // markers seen in less than half of the frames
};

// Looks at up to `max_frames` frames, evenly spread. Every marker weighs the less the more it
// moves, so that those on bone end up holding the shape. The mouth counts as shut in the fifth of
// the frames in which the markers lie closest together: an open jaw spreads them.
MarkerMotion MeasureMarkerMotion(const StageTracks& tracks, int max_frames = 400);

}  // namespace articap
