// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/head_pose.h"
#include "core/parameter_track.h"
#include "core/report.h"
#include "core/tracks.h"
#include "rig/face_rig.h"

namespace articap {

// What a parameter may do, in the units of the track.
struct ParameterRange {
  double min = 0;
  double max = 1;
  std::string description;
};

// Distances of measured to virtual markers, mm of the speaker's head.
struct MarkerResiduals {
  std::vector<std::string> names;
  Eigen::MatrixXf distances_mm;  // frames x markers; NaN where the marker was not used
};

// Frames of a take, counted from 0.
struct FrameWindow {
  int first = 0;
  int count = 0;
};

// Everything the page shows of a take. What is a pointer may be null: its part of the page is left
// out. What is pointed at outlives the call.
struct ReportPageInput {
  std::string title;
  std::vector<StageReport> reports;            // in the order of the stages
  const ParameterTrack* parameters = nullptr;  // needed
  std::vector<ParameterRange> ranges;          // a parameter each, or none
  const MarkerResiduals* residuals = nullptr;
  const HeadPoseTrack* head_pose = nullptr;
  const FaceRig* rig = nullptr;
  // In the rig frame, found by their frame numbers; they need not hold more than the window.
  const RigTracks* measured = nullptr;
  const RigTracks* virtual_markers = nullptr;
  // What the head in 3D plays; by default the first ten seconds that have parameters.
  std::optional<FrameWindow> window;
};

// One HTML page that needs no network: plots of the take, residuals, head motion, and the head in
// 3D with its markers over the window. Below 15 MB whatever the length of the take: beyond some
// hundred thousand values a plot keeps the least and the largest of every few frames. The same
// input gives the same bytes.
std::string BuildReportPage(const ReportPageInput& input);

}  // namespace articap
