// SPDX-License-Identifier: MIT
#include "render/lens_view.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "tests/support/matchers.h"

namespace articap {
namespace {

Camera TiltedCamera(const Lens& lens) {
  Camera camera;
  camera.width = 1280;
  camera.height = 720;
  camera.lens = lens;
  camera.cam_from_stage.rotation =
      Eigen::AngleAxisd(2.5, Eigen::Vector3d(0.9, 0.3, -0.2).normalized());
  camera.cam_from_stage.translation_mm = Eigen::Vector3d(30, -50, 800);
  return camera;
}

// How far from the points of the stage the rays pass that are sent through their pictures, mm.
double LargestMiss_mm(const Camera& camera) {
  const LensView view(camera);
  const Rigid3d stage_from_cam = camera.cam_from_stage.Inverse();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-0.5, camera.width - 0.5);
  std::uniform_real_distribution<double> down(-0.5, camera.height - 0.5);
  std::uniform_real_distribution<double> depth_mm(200, 1000);
  double largest_mm = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector2d somewhere_px{across(random), down(random)};
    const auto direction = Unproject(camera.lens, somewhere_px);
    if (!direction) continue;
    const Eigen::Vector3d point_in_cam = depth_mm(random) * *direction;
    const auto ray = view.RayThrough(Project(camera.lens, point_in_cam).value());
    EXPECT_TRUE(ray);
    const Eigen::Vector3d arm = stage_from_cam * point_in_cam - ray->origin_mm;
    largest_mm = std::max(largest_mm, (arm - ray->direction.dot(arm) * ray->direction).norm());
  }
  return largest_mm;
}

// The table is right to 1e-6 px in the middle of each cell, where cubic interpolation is at its
// worst. At 1 m and 800 px of focal length, and twice the obliquity of the picture's corners, that
// is 1e-6 / 800 * 1000 * 2 mm.
constexpr double kMiss_mm = 2.5e-6;

TEST(LensViewTest, RaysPassThroughThePointsThatProjectToTheirPixel) {
  const Lens pinhole = {1200, 1190, 640.5, 355, {}};
  EXPECT_LT(LargestMiss_mm(TiltedCamera(pinhole)), kMiss_mm);
  const Lens camcorder = {1200, 1190, 640.5, 355, {-0.28, 0.09, 0.001, -0.0007, -0.012, 0, 0, 0}};
  EXPECT_LT(LargestMiss_mm(TiltedCamera(camcorder)), kMiss_mm);
  const Lens rational = {900, 900, 610, 340, {0.4, -0.1, 0.002, 0.001, 0.01, 0.6, 0.05, 0}};
  EXPECT_LT(LargestMiss_mm(TiltedCamera(rational)), kMiss_mm);
}

TEST(LensViewTest, NothingIsSeenBeyondTheFoldAndAllIsRightBeforeIt) {
  // r (1 - 0.3 r^2) turns back at r = 1.054, 0.703 of the focal length from the middle: 562 px.
  const Lens barrel = {800, 800, 640, 360, {-0.3, 0, 0, 0, 0, 0, 0, 0}};
  const LensView view(TiltedCamera(barrel));
  EXPECT_FALSE(view.RayThrough({640 + 565, 360}));
  EXPECT_TRUE(view.RayThrough({640 + 561, 360}));
  // Close to the fold a pixel's light comes from wide apart; there points are solved for.
  EXPECT_LT(LargestMiss_mm(TiltedCamera(barrel)), 1e-4);
}

TEST(LensViewTest, PointsOutsideThePictureAreAnsweredToo) {
  const Lens lens = {1200, 1190, 640.5, 355, {-0.28, 0.09, 0.001, -0.0007, -0.012, 0, 0, 0}};
  const Camera camera = TiltedCamera(lens);
  const LensView view(camera);
  for (const Eigen::Vector2d& point_px :
       {Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(1279.5, 719.5), Eigen::Vector2d(-90, 300),
        Eigen::Vector2d(1400, 800)}) {
    const auto ray = view.RayThrough(point_px);
    ASSERT_TRUE(ray);
    const auto seen =
        Project(lens, camera.cam_from_stage * (ray->origin_mm + 500 * ray->direction));
    ASSERT_TRUE(seen);
    EXPECT_LT((*seen - point_px).norm(), 2 * LensView::kMostTableError_px);
  }
}

}  // namespace
}  // namespace articap
