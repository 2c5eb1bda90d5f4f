// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/tracks.h"

namespace articap {

// An instant with a meaning, e.g. of C3D's EVENT group.
struct MarkerEvent {
  double time_s =
      0;  // from the first frame of the *whole* recording (C3D: frame 1), as files have it
  std::string label;
  std::string context;
  std::string subject;
  std::string description;
};

// Analog channels recorded beside the markers; kept through conversions that can carry them.
struct AnalogChannel {
  std::string name;
  std::string unit;
  std::string description;
  std::vector<double> samples;  // in `unit`; num_frames x samples_per_frame
};

struct AnalogData {
  int samples_per_frame = 0;  // the analog rate is this times the marker rate
  std::vector<AnalogChannel> channels;
};

// What a marker file holds: positions in mm in the stage frame, and all that came with them.
struct MarkerRecording {
  StageTracks tracks;
  // Frames x markers, frame by frame; each empty where the source has none. C3D's residual in mm (0
  // for generated samples, NaN for missing ones) and the bits of the seven cameras that saw the
  // marker (0 where missing).
  std::vector<float> residuals_mm;
  std::vector<std::uint8_t> camera_masks;
  // The step that the source rounded its residuals to, 0 where unknown: C3D keeps a residual as a
  // multiple (0 to 255) of |POINT:SCALE|, and writing with the same step loses nothing.
  float residual_step_mm = 0;
  std::vector<std::string> descriptions;  // of each marker; may be empty
  std::string subject;                    // prefix of the labels ("Anna:chin"), taken off the names
  std::string source_unit;                // the file's own unit of length, e.g. "cm"
  std::vector<MarkerEvent> events;
  AnalogData analog;
  // What reading had to repair, drop or assume, each a sentence.
  std::vector<std::string> warnings;
};

// The frames from a time to before another, with all that belongs to them; their numbers
// stay, and their times to a nanosecond. Events stay too, since they count from the start of the
// whole recording.
MarkerRecording CropToTimes(const MarkerRecording& recording, SessionTime from, SessionTime to);

}  // namespace articap
