// SPDX-License-Identifier: MIT
#include "synthetic/camera_rigs.h"

#include <gmock/gmock.h>

#include "tests/support/matchers.h"

namespace articap {
namespace {

TEST(CameraRigsTest, CamerasLookWhereToldUpright) {
  Camera camera;
  camera.lens = {1000, 1000, 0, 0, {}};
  const LookAt look_at{{100, 50, 700}, {10, -20, 30}};
  camera.cam_from_stage = CamFromStage(look_at);
  EXPECT_THAT(camera.cam_from_stage * look_at.eye_mm, PointNear(Eigen::Vector3d(0, 0, 0), 1e-9));
  const double distance_mm = (look_at.target_mm - look_at.eye_mm).norm();
  EXPECT_THAT(camera.cam_from_stage * look_at.target_mm,
              PointNear(Eigen::Vector3d(0, 0, distance_mm), 1e-9));
  // Up in the stage is up in the picture, where y points down; the speaker's left is on the right.
  EXPECT_LT((camera.cam_from_stage.rotation * Eigen::Vector3d::UnitY()).y(), -0.9);
  EXPECT_GT((camera.cam_from_stage.rotation * Eigen::Vector3d::UnitX()).x(), 0.9);
}

TEST(CameraRigsTest, EveryCameraOfARingShowsTheHead) {
  const SyntheticCameras ring = RingOfCameras(6, 9);
  ASSERT_EQ(ring.array.cameras.size(), 6u);
  for (const Camera& camera : ring.array.cameras) {
    const double distance_mm = camera.cam_from_stage.translation_mm.norm();
    EXPECT_NEAR(distance_mm, 800, 20) << camera.name;
    for (const Eigen::Vector3d& point_mm :
         {Eigen::Vector3d(75, 0, 0), Eigen::Vector3d(-75, 0, 0), Eigen::Vector3d(0, 90, 60),
          Eigen::Vector3d(0, -90, 60)}) {
      const auto pixel = Project(camera.lens, camera.cam_from_stage * point_mm);
      ASSERT_TRUE(pixel);
      EXPECT_TRUE(pixel->x() > 0 && pixel->x() < 1279 && pixel->y() > 0 && pixel->y() < 719)
          << camera.name << " " << pixel->transpose();
    }
  }
}

TEST(CameraRigsTest, TheSameSeedGivesTheSameCameras) {
  const Camera once = RingOfCameras(3, 4).array.cameras[2];
  const Camera again = RingOfCameras(3, 4).array.cameras[2];
  const Camera other = RingOfCameras(3, 5).array.cameras[2];
  EXPECT_EQ(once.lens, again.lens);
  EXPECT_NE(once.lens, other.lens);
  EXPECT_THAT(again.cam_from_stage, Rigid3dNear(once.cam_from_stage, 0, 0));
}

TEST(CameraRigsTest, TheMirrorShowsTheFaceInProfileBesideItself) {
  const SyntheticCameras set_up = MirrorSetUp(4, 1);
  const Eigen::Vector3d nose_mm(0, 0, 100), ear_mm(0, 0, 0);
  const CameraArray& array = set_up.array;
  const auto direct = Project(array, {0, -1}, nose_mm);
  const auto nose = Project(array, {0, 0}, nose_mm);
  const auto ear = Project(array, {0, 0}, ear_mm);
  ASSERT_TRUE(direct && nose && ear);
  EXPECT_LT(direct->x(), 640);
  EXPECT_GT(ear->x(), 640);
  // 45 degrees exchange depth and breadth: what is nearer to the camera is farther to the right, by
  // 100 mm at a distance of some 880 mm.
  EXPECT_NEAR(nose->x() - ear->x(), 1800 * 100 / 880.0, 20);
  EXPECT_NEAR(ear->y(), nose->y(), 20);
}

TEST(CameraRigsTest, TwoMirrorsShowTheFaceFromEitherSide) {
  const CameraArray array = TwoMirrorSetUp(4, 1).array;
  ASSERT_EQ(array.mirrors.size(), 2u);
  EXPECT_EQ(array.NameOf({0, 0}), "front/left");
  EXPECT_EQ(array.NameOf({0, 1}), "front/right");
  const Eigen::Vector3d nose_mm(0, 0, 125), ear_mm(0, 0, 0);
  const auto left_nose = Project(array, {0, 0}, nose_mm), left_ear = Project(array, {0, 0}, ear_mm);
  const auto right_nose = Project(array, {0, 1}, nose_mm);
  const auto right_ear = Project(array, {0, 1}, ear_mm);
  ASSERT_TRUE(left_nose && left_ear && right_nose && right_ear);
  EXPECT_GT(left_nose->x(), left_ear->x());
  EXPECT_LT(right_nose->x(), right_ear->x());
  for (const auto& point_px : {*left_nose, *right_nose})
    EXPECT_TRUE(point_px.x() > 20 && point_px.x() < 1260) << "in the picture, with room to move";
}

TEST(CameraRigsTest, RenderMirrorsAreTheMirrorsOfTheArray) {
  const SyntheticCameras set_up = MirrorSetUp(4, 1);
  const auto mirrors = set_up.RenderMirrors();
  ASSERT_EQ(mirrors.size(), 1u);
  const Mirror& mirror = set_up.array.mirrors[0];
  EXPECT_THAT(mirrors[0].normal, PointNear(mirror.normal_in_stage, 0));
  EXPECT_NEAR(mirrors[0].normal.dot(mirrors[0].center_mm), mirror.distance_mm, 1e-9);
  EXPECT_EQ(mirrors[0].glass_mm, 4);
}

}  // namespace
}  // namespace articap
