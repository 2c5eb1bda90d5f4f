// SPDX-License-Identifier: MIT
#include "core/marker_recording.h"

#include <algorithm>
#include <cstddef>

namespace articap {
namespace {

// Of values that there are `per_frame` of in every frame; empty stays empty.
template <class Value>
std::vector<Value> FramesOf(const std::vector<Value>& values, int first, int count, int per_frame) {
  if (values.empty()) return {};
  const auto begin = values.begin() + std::ptrdiff_t{first} * per_frame;
  return {begin, begin + std::ptrdiff_t{count} * per_frame};
}

}  // namespace

MarkerRecording CropToTimes(const MarkerRecording& recording, SessionTime from, SessionTime to) {
  const StageTracks& whole = recording.tracks;
  int first = 0, end = whole.num_frames();
  while (first < end && whole.time(first) < from) ++first;
  while (end > first && whole.time(end - 1) >= to) --end;
  const int count = end - first;
  const int markers = whole.num_markers();
  MarkerRecording part = recording;
  part.tracks = StageTracks(whole.names(), count, whole.rate_hz(), whole.first_frame() + first,
                            whole.time(first));
  for (int frame = 0; frame < count; ++frame)
    for (int marker = 0; marker < markers; ++marker)
      if (!whole.is_missing(first + frame, marker))
        part.tracks.Set(frame, marker, whole.position_mm(first + frame, marker),
                        whole.state(first + frame, marker), whole.sigma_mm(first + frame, marker));
  part.residuals_mm = FramesOf(recording.residuals_mm, first, count, markers);
  part.camera_masks = FramesOf(recording.camera_masks, first, count, markers);
  for (AnalogChannel& channel : part.analog.channels)
    channel.samples = FramesOf(channel.samples, first, count, recording.analog.samples_per_frame);
  return part;
}

}  // namespace articap
