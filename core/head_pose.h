// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/tracks.h"
#include "core/transforms.h"

namespace articap {

// How the head was factored out of the movement of the markers.
enum class StabilizationMode : std::uint8_t {
  kRigid,        // from three or more reference markers
  kTranslation,  // one marker gives the position; the rotation is declared identity
  kNone,         // the data were in a head frame already
};
const char* NameOf(StabilizationMode mode);

enum class HeadPoseStatus : std::uint8_t {
  kOk,
  kTooFewReferences,  // the pose is not known
  kIllConditioned,    // the references seen lie too near to a line: the pose is not known
  kLargeResidual,     // found, but the references do not fit the reference shape, or only three do
};
const char* NameOf(HeadPoseStatus status);

struct HeadPose {
  Rigid3d head_from_stage;  // identity where not known
  // RMS over the reference markers used (seen, and not outliers) of their own best alignment,
  // before the movement of the head is smoothed; NaN where not known.
  double residual_mm = 0;
  HeadPoseStatus status = HeadPoseStatus::kOk;

  bool is_known() const {
    return status == HeadPoseStatus::kOk || status == HeadPoseStatus::kLargeResidual;
  }
};

// Head axes: x to the speaker's left, y up, z forward.
struct HeadPoseTrack {
  StabilizationMode mode = StabilizationMode::kNone;
  double rate_hz = 1;
  int first_frame = 1;
  SessionTime start;
  std::vector<HeadPose> poses;
};

// Every marker in the head frame. Samples of frames whose pose is not known are missing.
HeadTracks ToHead(const StageTracks& tracks, const HeadPoseTrack& head_pose);

// CSV: frame,time_s,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz,residual_mm,status; the transform
// head_from_stage; empty cells where the pose is not known; a first line "# mode: rigid, rate_hz:
// 60" (pandas: read_csv(..., comment="#")). Rows must follow one another at that rate.
std::string WriteHeadPoseCsv(const HeadPoseTrack& track);
Result<HeadPoseTrack> ParseHeadPoseCsv(const std::string& text, const std::string& source_name);

}  // namespace articap
