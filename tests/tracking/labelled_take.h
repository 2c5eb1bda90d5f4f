// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "core/marker_recording.h"
#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "tracking/label.h"

namespace articap {

// Markers in a row, 20 mm apart, that nod together, as two cameras see them and labels name them:
// all known, for tests of what comes after labelling. The head's frame is the stage.
struct LabelledTake {
  CameraArray array;
  PointClouds clouds;
  std::vector<std::vector<std::vector<Dot>>> instants;  // by frame and camera
  MarkerTemplate marker_template;
  Labelling labelling;

  MarkerRecording Recording() const;
  CloudPoint& PointOf(int frame, int marker) {
    return clouds.frames[frame][labelling.frames[frame].points[marker]];
  }
};
LabelledTake MakeLabelledTake(const std::vector<std::string>& names, int num_frames,
                              double rate_hz = 60, double noise_mm = 0.01);

}  // namespace articap
