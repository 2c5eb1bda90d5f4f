// SPDX-License-Identifier: MIT
#pragma once

#include <gmock/gmock.h>

#include <span>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/marker_io.h"

namespace articap {

inline Result<MarkerRecording> Parse(const std::string& bytes, const std::string& name = "test",
                                     const MarkerReadOptions& options = {}) {
  return ParseMarkers(std::as_bytes(std::span(bytes)), name, options);
}

// What must be readable.
inline MarkerRecording ParseOrThrow(const std::string& bytes, const std::string& name = "test",
                                    const MarkerReadOptions& options = {}) {
  auto recording = Parse(bytes, name, options);
  if (!recording) throw std::runtime_error(recording.error().message);
  return std::move(*recording);
}

// The message of what must not be.
inline std::string FailureOf(const std::string& bytes, const std::string& name = "test",
                             const MarkerReadOptions& options = {}) {
  const auto recording = Parse(bytes, name, options);
  return recording ? "(was read)" : recording.error().message;
}

inline std::string Joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + "\n";
  return text;
}

inline const std::vector<MarkerFormat>& AllFormats() {
  static const std::vector<MarkerFormat> kFormats = {
      MarkerFormat::kC3d,      MarkerFormat::kTrc,       MarkerFormat::kQualisysTsv,
      MarkerFormat::kNexusCsv, MarkerFormat::kMotiveCsv, MarkerFormat::kPlainCsv};
  return kFormats;
}

// Three markers of "Anna" over five frames, with a missing, a filled and an exactly zero sample,
// and all that a C3D file can carry beside them.
inline MarkerRecording SmallRecording() {
  MarkerRecording recording;
  recording.tracks =
      StageTracks({"brow", "chin", "lip upper"}, 5, 59.94, 11, TimeOfFrame(10, 59.94));
  for (int frame = 0; frame < 5; ++frame) {
    recording.tracks.Set(frame, 0, {1.0625 * frame, 120.5, -3.0009765625});
    if (frame != 2) recording.tracks.Set(frame, 1, {-0.03125, -60.25 - frame, 12345.5});
    recording.tracks.Set(frame, 2, {5, 0.0625 * frame, 80},
                         frame == 3 ? SampleState::kFilled : SampleState::kMeasured);
  }
  recording.tracks.Set(4, 1, {0, 0, 0});
  recording.residuals_mm.assign(15, 0.375F);
  recording.residuals_mm[2 * 3 + 1] = std::numeric_limits<float>::quiet_NaN();
  recording.residuals_mm[3 * 3 + 2] = 0;
  recording.camera_masks.assign(15, 0b0101);
  recording.camera_masks[2 * 3 + 1] = 0;
  recording.camera_masks[3 * 3 + 2] = 0;
  recording.descriptions = {"between the brows", "", "above the lip"};
  recording.subject = "Anna";
  recording.source_unit = "mm";
  recording.events = {{0.25, "begin", "General", "Anna", "first word"},
                      {61.125, "end", "", "", ""}};
  recording.analog.samples_per_frame = 2;
  recording.analog.channels = {{"audio", "V", "sync", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
                               {"trigger", "", "", std::vector<double>(10, -0.5)}};
  return recording;
}

}  // namespace articap
