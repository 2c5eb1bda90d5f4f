// SPDX-License-Identifier: MIT
#include "synthetic/wand_scene.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/support/matchers.h"

namespace articap {
namespace {

const CameraModel kSmall = {.width = 640, .height = 360, .focal_px = 900};

// The middle of the light over the background within a few radii of a place.
Eigen::Vector2d LightNear(const LinearPicture& picture, const Eigen::Vector2d& near_px,
                          int reach_px, float background) {
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  double light = 0;
  const int middle_x = static_cast<int>(near_px.x()), middle_y = static_cast<int>(near_px.y());
  for (int y = middle_y - reach_px; y <= middle_y + reach_px; ++y)
    for (int x = middle_x - reach_px; x <= middle_x + reach_px; ++x) {
      const double over =
          picture.rgb[static_cast<std::size_t>(y) * picture.width + x].x() - background;
      sum_px += over * Eigen::Vector2d(x, y);
      light += over;
    }
  return sum_px / light;
}

// A ball's outline is centred a little farther out than its centre: by about the offset from the
// axis times (radius / distance)^2, here less than 370 px * (7 / 780)^2 = 0.03 px; sampling adds
// a hundredth.
TEST(WandSceneTest, BallsAppearAtTheirCentres) {
  const Studio studio(RingOfCameras(3, 2, kSmall));
  const Wand wand = {.rod_radius_mm = 1e-4};  // too thin to be seen
  const Rigid3d pose = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d(0.2, -0.3, 1).normalized())),
      {12, -9, 20}};
  const Scene scene = WandScene(studio, wand, pose);
  const std::vector<ViewTruth> truths = TruthOfWand(studio, wand, pose);
  ASSERT_EQ(truths.size(), 3u);
  for (int camera = 0; camera < 3; ++camera) {
    const LinearPicture picture = studio.Render(scene, camera);
    EXPECT_TRUE(truths[camera].all_visible());
    for (const Eigen::Vector2d& true_px : truths[camera].points_px)
      EXPECT_LT((LightNear(picture, true_px, 16, scene.background.x()) - true_px).norm(), 0.04);
  }
}

TEST(WandSceneTest, ABallBehindTheOtherIsNotVisible) {
  const Studio studio(RingOfCameras(1, 2, kSmall));
  const Eigen::Vector3d eye_mm =
      studio.cameras().array.cameras[0].cam_from_stage.Inverse().translation_mm;
  const Rigid3d end_on = {Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), eye_mm),
                          {0, 0, 0}};
  const std::vector<ViewTruth> truths = TruthOfWand(studio, {}, end_on);
  EXPECT_FALSE(truths[0].visible[0]);
  EXPECT_TRUE(truths[0].visible[1]);
}

TEST(WandSceneTest, WandsAreWavedSmoothlyWithinTheirBox) {
  const Eigen::Vector3d reach_mm(70, 45, 80);
  const WandPath path(4, reach_mm);
  constexpr double kStep_s = 0.001;
  // The fastest swing, in all axes at once.
  const double fastest_mm_s = 2 * std::numbers::pi * 0.6 * reach_mm.norm();
  for (int step = 0; step < 5000; ++step) {
    const Rigid3d now = path.StageFromWandAt(step * kStep_s);
    const Rigid3d next = path.StageFromWandAt((step + 1) * kStep_s);
    ASSERT_TRUE((now.translation_mm.cwiseAbs().array() <= reach_mm.array()).all());
    ASSERT_LE((next.translation_mm - now.translation_mm).norm(), fastest_mm_s * kStep_s);
  }
  EXPECT_THAT(WandPath(4).StageFromWandAt(1.5), Rigid3dNear(path.StageFromWandAt(1.5), 0, 0));
  EXPECT_GT(
      (WandPath(5).StageFromWandAt(1.5).translation_mm - path.StageFromWandAt(1.5).translation_mm)
          .norm(),
      1);
}

}  // namespace
}  // namespace articap
