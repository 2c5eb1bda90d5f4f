// SPDX-License-Identifier: MIT
#include "render/rig_view.h"

#include <gmock/gmock.h>

#include "tests/support/matchers.h"

namespace articap {
namespace {

// Two triangles that share an edge, one of skin and one of spectacles.
FaceRig TwoTriangleRig() {
  RigDefinition rig;
  rig.name = "two triangles";
  rig.mesh.vertices = {{-80, -110, 0}, {80, -110, 0}, {80, 110, 0}, {-80, 110, 60}};
  rig.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  rig.colors.assign(4, Eigen::Vector3f(0.6f, 0.4f, 0.3f));
  rig.part_names = {"skin", "spectacles"};
  rig.triangle_part = {0, 1};
  rig.region_names = {"skull"};
  rig.triangle_region = {0, 0};
  rig.landmarks = {{"nose_tip", 2}, {"menton", 1}};
  rig.parameters = {{"lift", ParameterUnit::kMillimetre, -5, 5, "", ""}};
  rig.morph_targets = {{0, {{2}, {{0, 1, 0}}}}};
  return FaceRig::Create(std::move(rig)).value();
}

TEST(RigView, PartsAreMeshesOfTheirOwn) {
  const FaceRig rig = TwoTriangleRig();
  const Scene scene = SceneOf(rig, Eigen::VectorXd::Constant(1, 3.0));
  ASSERT_EQ(scene.meshes.size(), 2u);
  ASSERT_EQ(scene.meshes[0].mesh.vertices.size(), 3u);
  EXPECT_THAT(scene.meshes[0].mesh.vertices[2], PointNear(Eigen::Vector3d(80, 113, 0), 1e-12));
}

TEST(RigView, SpectaclesAndLandmarksCanBeChosen) {
  const FaceRig rig = TwoTriangleRig();
  const Eigen::VectorXd neutral = Eigen::VectorXd::Zero(1);
  RigViewOptions options{.show_spectacles = false, .show_landmarks = true};
  options.markers.push_back({{1, 2, 3}, 2.0, Eigen::Vector3f::Ones()});
  const Scene scene = SceneOf(rig, neutral, options);
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.spheres.size(), 3u);
  EXPECT_THAT(scene.spheres[0].center_mm, PointNear(Eigen::Vector3d(1, 2, 3), 0));
  EXPECT_THAT(scene.spheres[1].center_mm, PointNear(Eigen::Vector3d(80, 110, 0), 0));
}

TEST(RigView, CamerasShowTheWholeHead) {
  const FaceRig rig = TwoTriangleRig();
  for (const FaceView view : {FaceView::kFront, FaceView::kThreeQuarter, FaceView::kSide}) {
    const PinholeView camera = HeadCamera(rig, view, 300, 400);
    for (const Eigen::Vector3d& vertex : rig.neutral_mesh().vertices) {
      const Eigen::Vector2d pixel = camera.Project(vertex);
      EXPECT_TRUE(pixel.x() > 0 && pixel.x() < 299 && pixel.y() > 0 && pixel.y() < 399)
          << pixel.transpose();
    }
  }
  // In profile from the speaker's left, the nose (towards +z) points to the picture's left.
  const PinholeView side = HeadCamera(rig, FaceView::kSide, 300, 400);
  EXPECT_LT(side.Project({0, 0, 60}).x(), side.Project({0, 0, 0}).x());
}

TEST(RigView, MouthCameraFramesTheLowerFace) {
  const FaceRig rig = TwoTriangleRig();
  const PinholeView camera = MouthCamera(rig, 0, 0, 300, 300);
  const double nose_y = camera.Project(rig.neutral_mesh().vertices[2]).y();
  const double chin_y = camera.Project(rig.neutral_mesh().vertices[1]).y();
  EXPECT_GT(nose_y, 0);
  EXPECT_LT(chin_y, 299);
  EXPECT_GT(chin_y - nose_y, 150);
}

}  // namespace
}  // namespace articap
