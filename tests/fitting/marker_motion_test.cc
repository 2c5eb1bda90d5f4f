// SPDX-License-Identifier: MIT
#include "fitting/marker_motion.h"

#include <gtest/gtest.h>

#include "core/marker_set.h"
#include "rig/default_head/default_head.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

TEST(MarkerMotionTest, MarkersOnTheSkullAreStillWhileTheHeadMoves) {
  SyntheticTakeOptions options;
  options.seed = 5;
  options.speech.num_sentences = 2;
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  const SyntheticTake take = SynthesizeTake(MakeDefaultHead().value(), set, options).value();
  const MarkerMotion motion = MeasureMarkerMotion(take.markers.tracks);
  ASSERT_EQ(motion.markers.size(), 35u);
  EXPECT_TRUE(motion.left_out.empty());
  for (const MarkerMotion::Marker& marker : motion.markers) {
    if (marker.name.starts_with("spectacles")) {
      EXPECT_LT(marker.motion_mm, 0.2) << marker.name;
    }
    if (marker.name == "chin") {
      EXPECT_GT(marker.motion_mm, 1);
    }
  }
}

}  // namespace
}  // namespace articap
