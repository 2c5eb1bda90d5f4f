// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/camera.h"
#include "render/lens_view.h"
#include "render/render.h"
#include "render/traced_scene.h"
#include "tests/support/matchers.h"

namespace articap {
namespace {

// A camera 900 mm before the origin and a mirror that shows it from the side.
CameraArray OneMirror(double glass_mm) {
  CameraArray array;
  Camera camera;
  camera.name = "front";
  camera.width = 1280;
  camera.height = 720;
  camera.lens = {1500, 1490, 640, 360, {-0.2, 0.05, 0.001, 0.0005, 0, 0, 0, 0}};
  camera.cam_from_stage.translation_mm = Eigen::Vector3d{5, 10, 900};
  array.cameras = {camera};
  Mirror mirror;
  mirror.name = "side";
  mirror.normal_in_stage = Eigen::Vector3d{1, 0.1, 1}.normalized();
  mirror.distance_mm = 150;
  mirror.glass_mm = glass_mm;
  array.mirrors = {mirror};
  return array;
}

// The same mirror, with edges far from where the tests look.
RenderMirror WideMirror(const Mirror& mirror) {
  return {.center_mm = mirror.distance_mm * mirror.normal_in_stage,
          .normal = mirror.normal_in_stage,
          .width_mm = 500,
          .height_mm = 500,
          .glass_mm = mirror.glass_mm,
          .glass_index = mirror.glass_index};
}

// core/camera.h says where a mirror shows a point, by the plate's apparent shift; the renderer
// traces the ray of that pixel by Snell's law. They agree to what the lens table is good for.
TEST(MirrorTest, RaysComeToThePointsThatProjectToTheirPixel) {
  for (const double glass_mm : {0.0, 3.0, 6.0}) {
    const CameraArray array = OneMirror(glass_mm);
    const LensView view(array.cameras[0]);
    const MirrorPlane mirror(WideMirror(array.mirrors[0]));
    for (const Eigen::Vector3d& point_mm :
         {Eigen::Vector3d(20, -30, 10), Eigen::Vector3d(-40, 50, 60), Eigen::Vector3d(0, 0, 0)}) {
      const auto pixel = Project(array, {0, 0}, point_mm);
      ASSERT_TRUE(pixel);
      const auto meeting = mirror.Meet(view.RayThrough(*pixel).value());
      ASSERT_TRUE(meeting && meeting->reflected);
      const SightRay& ray = *meeting->reflected;
      EXPECT_THAT(ray.origin_mm + ray.direction.dot(point_mm - ray.origin_mm) * ray.direction,
                  PointNear(point_mm, 2e-6))
          << glass_mm << " mm of glass";
    }
  }
}

TEST(MirrorTest, SceneIsSeenInTheMirrorAndDirectly) {
  const CameraArray array = OneMirror(4);
  const LensView view(array.cameras[0]);
  Scene scene;
  scene.mirrors = {WideMirror(array.mirrors[0])};
  const Eigen::Vector3d center_mm(20, -30, 10);
  scene.spheres = {{center_mm, 5, Eigen::Vector3f::Ones()}};
  const TracedScene traced(scene);
  for (const View& how : array.views()) {
    const auto pixel = Project(array, how, center_mm);
    const SightEnd end = traced.Follow(view.RayThrough(pixel.value()).value());
    ASSERT_TRUE(end.surface) << array.NameOf(how);
    EXPECT_NEAR((end.surface->position_mm.cast<double>() - center_mm).norm(), 5, 1e-3);
    EXPECT_EQ(end.num_mirrors, how.mirror < 0 ? 0 : 1);
    EXPECT_FLOAT_EQ(end.transmission, how.mirror < 0 ? 1 : 0.92f);
  }
}

TEST(MirrorTest, FrameAndBackAreDarkAndBesidesThereIsNothing) {
  RenderMirror mirror{.center_mm = Eigen::Vector3d::Zero(),
                      .normal = -Eigen::Vector3d::UnitZ(),
                      .width_mm = 100,
                      .height_mm = 60,
                      .frame_mm = 8};
  const MirrorPlane plane(mirror);
  const auto meet = [&](double x, double y, double from_z) {
    return plane.Meet({{x, y, from_z}, {0, 0, from_z > 0 ? -1.0 : 1.0}});
  };
  ASSERT_TRUE(meet(49, 29, 100));
  EXPECT_TRUE(meet(49, 29, 100)->reflected);
  ASSERT_TRUE(meet(51, 0, 100) && meet(0, 37, 100) && meet(0, 0, -100));
  EXPECT_FALSE(meet(51, 0, 100)->reflected);
  EXPECT_FALSE(meet(0, 37, 100)->reflected);
  EXPECT_FALSE(meet(0, 0, -100)->reflected) << "the back";
  EXPECT_FALSE(meet(59, 0, 100));
  EXPECT_FALSE(meet(0, -39, 100));
}

TEST(MirrorTest, MirrorsThatFaceEachOtherEndAfterTheLastReflection) {
  Scene scene;
  scene.mirrors = {{.center_mm = {0, 0, -50}, .normal = -Eigen::Vector3d::UnitZ()},
                   {.center_mm = {0, 0, 50}, .normal = Eigen::Vector3d::UnitZ()}};
  const SightEnd end = TracedScene(scene).Follow({{0, 0, 0}, {0, 0, 1}});
  EXPECT_FALSE(end.surface);
  EXPECT_EQ(end.num_mirrors, SightEnd::kMostMirrors);
  EXPECT_EQ(end.mirrors[0], 1);
  EXPECT_EQ(end.mirrors[1], 0);
  EXPECT_NEAR(end.transmission, std::pow(0.92, SightEnd::kMostMirrors), 1e-6);
}

TEST(MirrorTest, SurfacesBeforeAMirrorHideIt) {
  Scene scene;
  scene.mirrors = {{.center_mm = {0, 0, -50}, .normal = -Eigen::Vector3d::UnitZ()}};
  scene.spheres = {{{0, 0, 0}, 5, Eigen::Vector3f::Ones()}};
  const TracedScene traced(scene);
  EXPECT_EQ(traced.Follow({{0, 0, 100}, {0, 0, -1}}).num_mirrors, 0);
  const SightEnd around = traced.Follow({{20, 0, 100}, Eigen::Vector3d(-20, 0, -150).normalized()});
  EXPECT_EQ(around.num_mirrors, 1);
  EXPECT_FALSE(around.surface);
}

}  // namespace
}  // namespace articap
