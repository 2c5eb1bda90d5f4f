// SPDX-License-Identifier: MIT
#include "tracking/learn_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_data.h"
#include "tests/tracking/speaker_dots.h"

namespace articap {
namespace {

MarkerTemplate LayoutOfMap(const std::string& map) {
  return LayoutOf(ReadMarkerSet(SourceFolder() / "maps" / (map + ".toml")).value()).value();
}

SpeakerDotsOptions FourCameras(std::uint64_t seed) {
  CameraModel model;
  model.width = 640;
  model.height = 480;
  model.focal_px = 1100;
  SpeakerDotsOptions options;
  options.cameras = RingOfCameras(4, seed, model);
  options.seed = seed;
  options.num_frames = 120;
  return options;
}

TEST(LearnTemplateTest, FromTypicalPlacesAlone) {
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    const SpeakerDots scene = MakeSpeakerDots(FourCameras(seed));
    const PointClouds clouds = CloudsOf(scene);
    const std::vector<int> frames = {0};
    const auto learnt = LearnTemplate(clouds, LayoutOfMap("spectacles30"), frames,
                                      LikelyAttitudes(scene.cameras.array), {});
    ASSERT_TRUE(learnt) << learnt.error().message;
    const Labelling labelling = LabelClouds(clouds, *learnt, {});
    const LabelScore score = ScoreOf(scene, clouds, labelling);
    RecordProperty("seed_" + std::to_string(seed), std::to_string(score.right) + " of " +
                                                       std::to_string(score.labelled) + " of " +
                                                       std::to_string(score.seen));
    EXPECT_GE(score.right, 0.998 * score.labelled);
    EXPECT_GE(score.labelled, 0.97 * score.seen);
  }
}

// Of a marker the frame that the template starts from shows nothing but a false dot, in one view.
TEST(LearnTemplateTest, AFalseDotInTheFirstFrameIsForgotten) {
  SpeakerDots scene = MakeSpeakerDots(FourCameras(1));
  const auto stud = static_cast<int>(
      std::find(scene.names.begin(), scene.names.end(), "spectacles_1") - scene.names.begin());
  bool has_false_dot = false;
  for (std::size_t camera = 0; camera < scene.dots[0].size(); ++camera) {
    auto& owners = scene.owners[0][camera];
    const auto owner = std::find(owners.begin(), owners.end(), stud);
    if (owner == owners.end()) continue;
    const auto index = owner - owners.begin();
    if (!has_false_dot) {
      scene.dots[0][camera][index].center_px += Eigen::Vector2d(-30, 0);
      *owner = -1;
      has_false_dot = true;
    } else {
      scene.dots[0][camera].erase(scene.dots[0][camera].begin() + index);
      owners.erase(owner);
    }
  }
  ASSERT_TRUE(has_false_dot);
  const PointClouds clouds = CloudsOf(scene);
  const std::vector<int> frames = {0};
  const auto learnt = LearnTemplate(clouds, LayoutOfMap("spectacles30"), frames,
                                    LikelyAttitudes(scene.cameras.array), {});
  ASSERT_TRUE(learnt) << learnt.error().message;
  const Labelling labelling = LabelClouds(clouds, *learnt, {});
  int labelled = 0;
  for (int frame = 0; frame < clouds.num_frames(); ++frame) {
    const CloudPoint* const point = LabelledPoint(clouds, labelling, frame, stud);
    labelled += point && scene.OwnerOf(frame, *point) == stud ? 1 : 0;
  }
  EXPECT_GE(labelled, 0.95 * clouds.num_frames());
}

TEST(LearnTemplateTest, SixMarkersInAMirror) {
  int labelled = 0, right = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 10, 14, 18, 23, 27, 29, 31, 35, 54}) {
    SCOPED_TRACE(seed);
    SpeakerDotsOptions options;
    options.cameras = MirrorSetUp(0, seed);
    options.map = "mirror6";
    options.rate_hz = 25;
    options.turn_deg = 5;
    options.most_oblique_deg = 105;  // half-balls on the midline stand out in profile
    options.dropout = 0;
    options.ghosts = 0;
    options.seed = seed;
    const SpeakerDots scene = MakeSpeakerDots(options);
    const PointClouds clouds = CloudsOf(scene);
    const std::vector<int> frames = {0, 10, 20, 30, 40, 50};
    const auto learnt = LearnTemplate(clouds, LayoutOfMap("mirror6"), frames,
                                      LikelyAttitudes(scene.cameras.array), {});
    ASSERT_TRUE(learnt) << learnt.error().message;
    const LabelScore score = ScoreOf(scene, clouds, LabelClouds(clouds, *learnt, {}));
    RecordProperty("seed_" + std::to_string(seed), std::to_string(score.right) + " of " +
                                                       std::to_string(score.labelled) + " of " +
                                                       std::to_string(score.seen));
    EXPECT_GE(score.labelled, 0.99 * score.seen);
    labelled += score.labelled;
    right += score.right;
  }
  EXPECT_GE(right, 0.999 * labelled);
}

TEST(LearnTemplateTest, AMirroredLayoutIsRefused) {
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps/spectacles30.toml").value();
  MarkerTemplate layout = LayoutOf(set).value();
  EXPECT_TRUE(RefuseMirrored(layout, set));
  for (TemplateMarker& marker : layout.markers) marker.position_mm.x() *= -1;
  const auto refused = RefuseMirrored(layout, set);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("left and right"));
}

}  // namespace
}  // namespace articap
