// SPDX-License-Identifier: MIT
#include "tracking/label.h"

#include <gtest/gtest.h>

#include "tests/tracking/speaker_dots.h"

namespace articap {
namespace {

CameraModel SmallCamera() {
  CameraModel model;
  model.width = 640;
  model.height = 480;
  model.focal_px = 1100;
  return model;
}

SpeakerDotsOptions FourCameras(std::uint64_t seed) {
  SpeakerDotsOptions options;
  options.cameras = RingOfCameras(4, seed, SmallCamera());
  options.seed = seed;
  return options;
}

std::string Describe(const LabelScore& score, const Labelling& labelling) {
  return "seen " + std::to_string(score.seen) + ", labelled " + std::to_string(score.labelled) +
         ", right " + std::to_string(score.right) + ", measured " + std::to_string(score.measured) +
         ", longest swap " + std::to_string(score.longest_swap) + ", rms " +
         std::to_string(score.rms_mm) + " mm, worst " + std::to_string(score.worst_mm) +
         " mm, searches " + std::to_string(labelling.searches) + ", repaired " +
         std::to_string(labelling.swaps_repaired);
}

TEST(LabelTest, FourCamerasWithDropoutsAndGhosts) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SpeakerDots scene = MakeSpeakerDots(FourCameras(seed));
    const PointClouds clouds = CloudsOf(scene);
    const Labelling labelling = LabelClouds(clouds, TemplateOf(scene, 0), {});
    const LabelScore score = ScoreOf(scene, clouds, labelling);
    SCOPED_TRACE(Describe(score, labelling));
    RecordProperty("seed_" + std::to_string(seed), Describe(score, labelling));
    EXPECT_GE(score.right, 0.999 * score.labelled);
    EXPECT_GE(score.labelled, 0.98 * score.seen);
    EXPECT_LE(score.longest_swap, 1);
    EXPECT_LE(score.rms_mm, 0.1);
  }
}

TEST(LabelTest, OneMirrorAndSixMarkers) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SpeakerDotsOptions options;
    options.cameras = MirrorSetUp(0, seed);
    options.map = "mirror6";
    options.most_oblique_deg = 101;  // half-balls on the midline stand out against the profile
    options.rate_hz = 25;
    options.turn_deg = 5;
    options.dropout = 0;
    options.ghosts = 0;
    options.seed = seed;
    const SpeakerDots scene = MakeSpeakerDots(options);
    const PointClouds clouds = CloudsOf(scene);
    const Labelling labelling = LabelClouds(clouds, TemplateOf(scene, 0), {});
    const LabelScore score = ScoreOf(scene, clouds, labelling);
    RecordProperty("seed_" + std::to_string(seed), Describe(score, labelling));
    SCOPED_TRACE(Describe(score, labelling));
    EXPECT_EQ(score.right, score.labelled);
    EXPECT_EQ(score.labelled, score.seen);
    EXPECT_LE(score.rms_mm, 0.08);
  }
}

TEST(LabelTest, OneMirrorAndThirtyFiveMarkers) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SpeakerDotsOptions options;
    options.cameras = MirrorSetUp(0, seed);
    options.rate_hz = 25;
    options.turn_deg = 10;
    options.most_oblique_deg = 101;
    options.dropout = 0.02;
    options.ghosts = 1;
    options.seed = seed;
    const SpeakerDots scene = MakeSpeakerDots(options);
    const PointClouds clouds = CloudsOf(scene);
    const Labelling labelling = LabelClouds(clouds, TemplateOf(scene, 0), {});
    const LabelScore score = ScoreOf(scene, clouds, labelling);
    RecordProperty("seed_" + std::to_string(seed), Describe(score, labelling));
    SCOPED_TRACE(Describe(score, labelling));
    // Most markers are seen by one view alone, on a face that turns.
    EXPECT_GE(score.right, 0.98 * score.labelled);
    EXPECT_GE(score.labelled, 0.95 * score.seen);
    EXPECT_LE(score.rms_mm, 0.08);
  }
}

}  // namespace
}  // namespace articap
