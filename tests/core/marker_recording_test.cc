// SPDX-License-Identifier: MIT
#include "core/marker_recording.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/core/marker_fixtures.h"
#include "tests/support/matchers.h"

namespace articap {
namespace {

TEST(MarkerRecordingTest, ACroppedRecordingKeepsNumbersTimesAndAllThatBelongsToItsFrames) {
  const MarkerRecording whole = SmallRecording();
  const SessionTime from = whole.tracks.time(1);
  const MarkerRecording part = CropToTimes(whole, from, whole.tracks.time(4));
  ASSERT_EQ(part.tracks.num_frames(), 3);
  EXPECT_EQ(part.tracks.first_frame(), whole.tracks.first_frame() + 1);
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_LE(std::abs((part.tracks.time(frame) - whole.tracks.time(frame + 1)).count()), 1);
    for (int marker = 0; marker < 3; ++marker) {
      EXPECT_EQ(part.tracks.state(frame, marker), whole.tracks.state(frame + 1, marker));
      if (part.tracks.is_missing(frame, marker)) continue;
      EXPECT_EQ(part.tracks.position_mm(frame, marker),
                whole.tracks.position_mm(frame + 1, marker));
    }
  }
  ASSERT_FALSE(whole.residuals_mm.empty());
  EXPECT_EQ(part.residuals_mm.size(), 9U);
  EXPECT_EQ(part.residuals_mm[0], whole.residuals_mm[3]);
  EXPECT_EQ(part.camera_masks.size(), whole.camera_masks.empty() ? 0U : 9U);
  for (std::size_t i = 0; i < whole.analog.channels.size(); ++i)
    EXPECT_EQ(part.analog.channels[i].samples.size(), 3U * whole.analog.samples_per_frame);
  EXPECT_EQ(part.events.size(), whole.events.size());
}

TEST(MarkerRecordingTest, OutsideThereAreNoFrames) {
  const MarkerRecording whole = SmallRecording();
  EXPECT_EQ(CropToTimes(whole, {}, whole.tracks.time(0)).tracks.num_frames(), 0);
  EXPECT_EQ(CropToTimes(whole, whole.tracks.time(5), whole.tracks.time(9)).tracks.num_frames(), 0);
  EXPECT_THAT(CropToTimes(whole, {}, whole.tracks.time(9)).tracks, TracksNear(whole.tracks, 0.0));
}

}  // namespace
}  // namespace articap
