// SPDX-License-Identifier: MIT
#include "fitting/spikes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace articap {

bool operator==(const Spike& a, const Spike& b) {
  return a.frame == b.frame && a.marker == b.marker;
}

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kRate_hz = 60;

// Two markers on a swing of 5 mm whose acceleration peaks at `peak_m_s2`.
RigTracks Swing(double peak_m_s2) {
  RigTracks tracks({"a", "b"}, 60, kRate_hz);
  const double radius_mm = 5;
  const double omega = std::sqrt(1e3 * peak_m_s2 / radius_mm);
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < 2; ++marker) {
      const double angle = omega * frame / kRate_hz;
      tracks.Set(frame, marker, {radius_mm * std::cos(angle), radius_mm * std::sin(angle), 0});
    }
  return tracks;
}

void Move(RigTracks* tracks, int frame, int marker, const Eigen::Vector3d& by_mm) {
  tracks->Set(frame, marker, tracks->position_mm(frame, marker) + by_mm);
}

TEST(FindSpikesTest, LeavesQuickSpeechAlone) { EXPECT_THAT(FindSpikes(Swing(20), {}), IsEmpty()); }

TEST(FindSpikesTest, FindsASpikeAndNotItsNeighbours) {
  RigTracks tracks = Swing(5);
  Move(&tracks, 20, 1, {0, 0, 10});
  Move(&tracks, 40, 0, {30, 0, 0});
  EXPECT_THAT(FindSpikes(tracks, {}), ElementsAre(Spike{20, 1}, Spike{40, 0}));
}

TEST(FindSpikesTest, FindsTwoInARow) {
  RigTracks tracks = Swing(5);
  Move(&tracks, 20, 0, {0, 0, 40});
  Move(&tracks, 21, 0, {0, 40, 0});
  EXPECT_THAT(FindSpikes(tracks, {}), ElementsAre(Spike{20, 0}, Spike{21, 0}));
}

TEST(FindSpikesTest, GapsAskForLargerSpikes) {
  // Two frames to the neighbours on either side allow 1.5 + 12.5 * 4 / 3.6 = 15.4 mm.
  RigTracks tracks = Swing(5);
  tracks.SetMissing(19, 0);
  tracks.SetMissing(21, 0);
  Move(&tracks, 20, 0, {0, 0, 12});
  EXPECT_THAT(FindSpikes(tracks, {}), IsEmpty());
  Move(&tracks, 20, 0, {0, 0, 12});
  EXPECT_THAT(FindSpikes(tracks, {}), ElementsAre(Spike{20, 0}));
}

TEST(FindSpikesTest, DoesNotJudgeAcrossLongGapsOrAtTheEnds) {
  RigTracks tracks = Swing(5);
  for (int frame = 10; frame < 20; ++frame) tracks.SetMissing(frame, 0);
  Move(&tracks, 20, 0, {0, 0, 200});
  Move(&tracks, 0, 1, {0, 0, 200});
  // The neighbours of what is not judged are, and may lose: here frame 21 and frame 1 have a
  // neighbour that is off by 200 mm.
  for (const Spike& spike : FindSpikes(tracks, {}))
    EXPECT_TRUE(spike.frame != 20 && spike.frame != 0) << spike.frame;
}

TEST(FindSpikesTest, AJumpThatStaysIsNotASpike) {
  // Markers that change places: the samples at the step are doubtful, those after it are not.
  RigTracks tracks = Swing(5);
  for (int frame = 30; frame < 60; ++frame) Move(&tracks, frame, 0, {25, 0, 0});
  EXPECT_LE(FindSpikes(tracks, {}).size(), 4u);
}

}  // namespace
}  // namespace articap
