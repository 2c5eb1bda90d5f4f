// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "report/report_page.h"

namespace articap {

// An egg with a jaw, two lips' worth of parameters and a few landmarks: a rig for tests.
FaceRig MakeEggRig();

// Something of everything that the page shows, from smooth gestures of the rig: parameters with
// gaps and undetermined sigmas, phones, residuals, a moving head, markers at the rig's landmarks.
struct SampleTake {
  std::vector<StageReport> reports;
  ParameterTrack parameters;
  std::vector<ParameterRange> ranges;
  MarkerResiduals residuals;
  HeadPoseTrack head_pose;
  RigTracks measured, virtual_markers;

  ReportPageInput Input(const FaceRig& rig) const;
};
SampleTake MakeSampleTake(const FaceRig& rig, int num_frames, double rate_hz = 60);

}  // namespace articap
