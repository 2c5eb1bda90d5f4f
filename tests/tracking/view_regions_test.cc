// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstdio>
#include <set>
#include <tuple>

#include "core/view_regions.h"
#include "tests/tracking/speaker_dots.h"

// What regions of views save the reconstruction.
namespace articap {
namespace {

SpeakerDots BeforeAMirror() {
  SpeakerDotsOptions options;
  options.cameras = MirrorSetUp(0, 3);
  options.num_frames = 40;
  options.turn_deg = 5;
  return MakeSpeakerDots(options);
}

struct Counts {
  int points = 0;
  int false_pairs = 0;                        // of two views, not both of one marker
  std::set<std::tuple<int, int, int>> pairs;  // the true ones: frame and two dots
};

Counts Count(const SpeakerDots& scene) {
  Counts counts;
  const PointClouds clouds = CloudsOf(scene);
  for (int frame = 0; frame < clouds.num_frames(); ++frame)
    for (const CloudPoint& point : clouds.frames[frame]) {
      ++counts.points;
      if (point.sights.size() < 2) continue;
      if (scene.OwnerOf(frame, point) < 0)
        ++counts.false_pairs;
      else
        counts.pairs.emplace(frame, point.sights[0].dot, point.sights[1].dot);
    }
  return counts;
}

TEST(ViewRegionsTest, FewerFalsePairsAndNoTrueOneLess) {
  SpeakerDots scene = BeforeAMirror();
  const Counts everywhere = Count(scene);
  ASSERT_TRUE(SetViewRegions({"front/left=500x720+780+0"}, scene.cameras.array));
  const Counts within = Count(scene);
  std::printf("  points %d, in regions %d; false pairs %d, %d; true pairs %zu, %zu\n",
              everywhere.points, within.points, everywhere.false_pairs, within.false_pairs,
              everywhere.pairs.size(), within.pairs.size());
  EXPECT_LT(within.points, 0.75 * everywhere.points);
  EXPECT_LT(within.false_pairs, everywhere.false_pairs);
  for (const auto& pair : everywhere.pairs) EXPECT_TRUE(within.pairs.contains(pair));
}

TEST(ViewRegionsTest, NothingIsSeenByAViewOutsideOfItsRegion) {
  SpeakerDots scene = BeforeAMirror();
  ASSERT_TRUE(SetViewRegions({"front/left=500x720+780+0"}, scene.cameras.array));
  const PointClouds clouds = CloudsOf(scene);
  for (int frame = 0; frame < clouds.num_frames(); ++frame)
    for (const CloudPoint& point : clouds.frames[frame])
      for (const DotSight& sight : point.sights) {
        const double x_px = scene.dots[frame][0][sight.dot].center_px.x();
        EXPECT_EQ(sight.view.mirror, x_px >= 779.5 ? 0 : -1);
      }
}

}  // namespace
}  // namespace articap
