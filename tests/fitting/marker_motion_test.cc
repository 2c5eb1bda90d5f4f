// SPDX-License-Identifier: MIT
#include "fitting/marker_motion.h"

#include <gtest/gtest.h>

#include "tests/support/spoken_take.h"

namespace articap {
namespace {

TEST(MarkerMotionTest, MarkersOnTheSkullAreStillWhileTheHeadMoves) {
  const SyntheticTake take = MakeSpokenTake({.seed = 5}).take;
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
