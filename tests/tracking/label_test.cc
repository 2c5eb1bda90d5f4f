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
         ", right " + std::to_string(score.right) + ", longest wrong run " +
         std::to_string(score.longest_wrong_run) + ", rms " + std::to_string(score.rms_mm) +
         " mm, worst " + std::to_string(score.worst_mm) + " mm, searches " +
         std::to_string(labelling.searches) + ", repaired " +
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
    EXPECT_LE(score.longest_wrong_run, 1);
    EXPECT_LE(score.rms_mm, 0.1);
  }
}

}  // namespace
}  // namespace articap
