// SPDX-License-Identifier: MIT
#include "core/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace articap {
namespace {

Lens Camcorder() {
  return {1200, 1190, 640.5, 355, {-0.28, 0.09, 0.001, -0.0007, -0.012, 0, 0, 0}};
}

TEST(CameraTest, UnprojectInvertsProject) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> across(-0.55, 0.55);
  std::uniform_real_distribution<double> depth(200, 3000);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d direction{across(random), across(random), 1};
    const double z = depth(random);
    const auto pixel = Project(Camcorder(), direction * z);
    ASSERT_TRUE(pixel);
    const auto seen = Unproject(Camcorder(), *pixel);
    ASSERT_TRUE(seen);
    EXPECT_LT((*seen - direction).norm(), 1e-10);
  }
}

TEST(CameraTest, RationalLensesInvertToo) {
  const Lens lens = {800, 800, 320, 240, {0.4, -0.1, 0, 0, 0.01, 0.6, 0.05, 0}};
  const Eigen::Vector3d direction{0.4, -0.3, 1};
  const auto seen = Unproject(lens, Project(lens, direction * 500).value());
  ASSERT_TRUE(seen);
  EXPECT_LT((*seen - direction).norm(), 1e-10);
}

TEST(CameraTest, NothingAppearsFromBehindOrFromBeyondTheFold) {
  EXPECT_FALSE(Project(Camcorder(), {0, 0, -100}));
  EXPECT_FALSE(Project(Camcorder(), {10, 0, 0}));
  // r (1 - 0.28 r^2 + 0.09 r^4 - 0.012 r^6) turns back near r = 2.
  const Lens barrel = {1000, 1000, 0, 0, {-0.3, 0, 0, 0, 0, 0, 0, 0}};
  EXPECT_TRUE(Project(barrel, {1.0, 0, 1}));
  EXPECT_FALSE(Project(barrel, {1.1, 0, 1}));  // the fold is at r = 1 / sqrt(0.9) = 1.054
  EXPECT_FALSE(Unproject(barrel, {800, 0}));   // the farthest that appears is 703 px
}

CameraArray MirrorSetUp(double glass_mm) {
  CameraArray array;
  Camera camera;
  camera.name = "front";
  camera.lens = {1500, 1500, 640, 360, {}};
  camera.cam_from_stage.translation_mm = Eigen::Vector3d{5, 10, 900};
  array.cameras = {camera};
  Mirror mirror;
  mirror.name = "side";
  mirror.normal_in_stage = Eigen::Vector3d{1, 0, 1}.normalized();
  mirror.distance_mm = 150;
  mirror.glass_mm = glass_mm;
  array.mirrors = {mirror};
  return array;
}

TEST(CameraTest, AMirrorShowsTheReflectedPoint) {
  const CameraArray array = MirrorSetUp(0);
  const Eigen::Vector3d point{20, -30, 10};
  const Eigen::Vector3d reflected = array.mirrors[0].Reflect(point);
  EXPECT_LT((array.mirrors[0].Reflect(reflected) - point).norm(), 1e-12);
  // Normal (1, 0, 1)/sqrt 2 exchanges x and -z, and shifts by sqrt 2 times the distance.
  const double shift = std::sqrt(2.0) * 150;
  EXPECT_LT((reflected - Eigen::Vector3d{shift - 10, -30, shift - 20}).norm(), 1e-12);
  const auto seen = Project(array, {0, 0}, point);
  const auto direct = Project(array, {0, -1}, reflected);
  ASSERT_TRUE(seen && direct);
  EXPECT_LT((*seen - *direct).norm(), 1e-12);
  EXPECT_FALSE(Project(array, {0, 0}, reflected)) << "it stands behind the mirror";
  EXPECT_EQ(array.NameOf({0, 0}), "front/side");
  EXPECT_EQ(array.views(), (std::vector<View>{{0, -1}, {0, 0}}));
}

// Traces the ray that leaves the camera through the glass, by Snell's law, and asks how far from
// the point it passes.
TEST(CameraTest, GlassBeforeTheMirrorBendsRaysAsSnellSays) {
  const CameraArray array = MirrorSetUp(5);
  const Mirror& mirror = array.mirrors[0];
  const Camera& camera = array.cameras[0];
  const Eigen::Vector3d point{20, -30, 10};
  const auto pixel = Project(array, {0, 0}, point);
  ASSERT_TRUE(pixel);
  const Rigid3d stage_from_cam = camera.cam_from_stage.Inverse();
  const Eigen::Vector3d eye = stage_from_cam.translation_mm;
  const Eigen::Vector3d ray =
      (stage_from_cam.rotation * Unproject(camera.lens, *pixel).value()).normalized();

  const Eigen::Vector3d& n = mirror.normal_in_stage;
  const double cos_air = ray.dot(n);
  const Eigen::Vector3d along = (ray - cos_air * n) / mirror.glass_index;  // sin in the glass
  const double cos_glass = std::sqrt(1 - along.squaredNorm());
  const double front = mirror.distance_mm - mirror.glass_mm;
  const Eigen::Vector3d enters = eye + ray * ((front - n.dot(eye)) / cos_air);
  const Eigen::Vector3d leaves = enters + 2 * mirror.glass_mm / cos_glass * along;
  const Eigen::Vector3d outward = ray - 2 * cos_air * n;
  const Eigen::Vector3d to_point = point - leaves;
  const double miss_mm = (to_point - outward * outward.dot(to_point)).norm();
  EXPECT_LT(miss_mm, 1e-6);
  const auto without_glass = Project(MirrorSetUp(0), {0, 0}, point);
  EXPECT_GT((*pixel - *without_glass).norm(), 3) << "5 mm of glass are no trifle";
}

TEST(CameraTest, PixelsThatAreNoNumbersLookNowhere) {
  const Lens lens = {1000, 1000, 640, 360, {-0.1}};
  for (const double bad : {std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), CameraSigmas::kUnknown}) {
    EXPECT_FALSE(Unproject(lens, {bad, 100}));
    EXPECT_FALSE(Unproject(lens, {100, bad}));
  }
}

}  // namespace
}  // namespace articap
