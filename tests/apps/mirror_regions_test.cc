// SPDX-License-Identifier: MIT
#include "apps/mirror_regions.h"

#include <gtest/gtest.h>

#include "core/view_regions.h"
#include "tests/tracking/speaker_dots.h"

namespace articap {
namespace {

SpeakerDots BeforeAMirror(const std::string& map) {
  SpeakerDotsOptions options;
  options.cameras = MirrorSetUp(0, 3);
  options.map = map;
  options.most_oblique_deg = 101;  // half-balls on the midline stand out against the profile
  options.num_frames = 60;
  options.turn_deg = 5;
  options.ghosts = 1;
  return MakeSpeakerDots(options);
}

DotVideo VideoOf(const SpeakerDots& scene) {
  const Camera& camera = scene.cameras.array.cameras[0];
  DotVideo video{.camera = camera.name, .width = camera.width, .height = camera.height};
  for (const auto& frame : scene.dots) video.pictures.push_back({0, {}, frame.front()});
  return video;
}

TEST(MirrorRegionsTest, EveryDotMayBeWhatItIs) {
  for (const char* map : {"mirror6", "spectacles30"}) {
    const SpeakerDots scene = BeforeAMirror(map);
    CameraArray array = scene.cameras.array;
    const std::vector<std::string> regions = RegionsByDots(array, VideoOf(scene), {});
    ASSERT_EQ(regions.size(), 2U) << map;
    ASSERT_TRUE(SetViewRegions(regions, array));
    int told = 0, dots = 0;
    for (int frame = 0; frame < scene.num_frames(); ++frame)
      for (std::size_t i = 0; i < scene.dots[frame][0].size(); ++i) {
        const int owner = scene.owners[frame][0][i];
        if (owner < 0) continue;
        const Eigen::Vector2d& seen_px = scene.dots[frame][0][i].center_px;
        const auto direct_px =
            Project(scene.cameras.array, {0, -1}, scene.positions_mm[frame][owner]);
        const bool is_direct = direct_px && (*direct_px - seen_px).norm() < 1;
        EXPECT_TRUE(array.MayShow({0, is_direct ? -1 : 0}, seen_px));
        told += array.MayShow({0, is_direct ? 0 : -1}, seen_px) ? 0 : 1;
        ++dots;
      }
    // And of nearly all it is told which.
    EXPECT_GT(told, 0.98 * dots) << map;
  }
}

TEST(MirrorRegionsTest, NothingIsSaidWhereSomebodyDrewThemOrThereIsNoClearMirror) {
  const SpeakerDots scene = BeforeAMirror("mirror6");
  const DotVideo video = VideoOf(scene);
  CameraArray drawn = scene.cameras.array;
  ASSERT_TRUE(SetViewRegions({"front/left=500x720+780+0"}, drawn));
  EXPECT_TRUE(RegionsByDots(drawn, video, {}).empty());
  CameraArray direct = scene.cameras.array;
  direct.mirrors.clear();
  EXPECT_TRUE(RegionsByDots(direct, video, {}).empty());
  EXPECT_TRUE(RegionsByDots(TwoMirrorSetUp(0, 3).array, video, {}).empty());
  // The mirror's dots are not its reflections: all of them twice as high.
  DotVideo other = video;
  for (DotPicture& picture : other.pictures)
    for (Dot& dot : picture.dots)
      if (dot.center_px.x() > 700) dot.center_px.y() = 2 * dot.center_px.y() - 300;
  EXPECT_TRUE(RegionsByDots(scene.cameras.array, other, {}).empty());
  EXPECT_TRUE(
      RegionsByDots(scene.cameras.array, {.camera = "front", .width = 1280, .height = 720}, {})
          .empty());
}

}  // namespace
}  // namespace articap
