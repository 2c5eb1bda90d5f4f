// SPDX-License-Identifier: MIT
#include "render/render.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/support/matchers.h"

namespace articap {
namespace {

// White things on black, without shading: the light of a pixel is how much of it they cover.
Scene SilhouetteScene() {
  Scene scene;
  scene.lights.clear();
  scene.ambient = Eigen::Vector3f::Ones();
  scene.background = Eigen::Vector3f::Zero();
  return scene;
}

RenderOptions SilhouetteOptions() { return {.samples_per_side = 8, .occlusion_mm = 0}; }

Eigen::Vector2d Centroid(const LinearPicture& picture) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double light = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double value = picture.rgb[static_cast<std::size_t>(y) * picture.width + x].y();
      sum += value * Eigen::Vector2d(x, y);
      light += value;
    }
  return sum / light;
}

MATCHER_P2(PixelNear, point_px, tolerance_px, "is the pixel position within the tolerance") {
  const double distance = (Eigen::Vector2d(arg) - Eigen::Vector2d(point_px)).norm();
  *result_listener << "which is " << distance << " px away";
  return distance <= tolerance_px;
}

// A unit square in the plane z = 0, facing +z.
RenderMesh Square(double half_mm, const Eigen::Vector3f& color) {
  RenderMesh square;
  square.mesh.vertices = {{-half_mm, -half_mm, 0},
                          {half_mm, -half_mm, 0},
                          {half_mm, half_mm, 0},
                          {-half_mm, half_mm, 0}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.colors.assign(4, color);
  square.material = {.gloss = 0};
  return square;
}

TEST(Render, SpheresAppearAtTheirProjectedCentres) {
  const LookAt look_at{{200, 300, 900}, {10, 20, 30}};
  const PinholeView pinhole(look_at, 200, 160, 120);
  const OrthographicView orthographic(look_at, 200, 160, 120);
  for (const Eigen::Vector3d& center_mm :
       {Eigen::Vector3d(10, 20, 30), Eigen::Vector3d(-31.7, 48.2, 12.9),
        Eigen::Vector3d(52.3, -21.9, 77.7)}) {
    Scene scene = SilhouetteScene();
    scene.spheres.push_back({center_mm, 5.0, Eigen::Vector3f::Ones()});
    EXPECT_THAT(Centroid(RenderLinear(scene, pinhole, SilhouetteOptions())),
                PixelNear(pinhole.Project(center_mm), 0.05));
    EXPECT_THAT(Centroid(RenderLinear(scene, orthographic, SilhouetteOptions())),
                PixelNear(orthographic.Project(center_mm), 0.05));
  }
}

TEST(Render, RaysPassThroughThePointsThatProjectToTheirPixel) {
  const PinholeView camera({{200, 300, 900}, {10, 20, 30}}, 200, 160, 120);
  const Eigen::Vector3d point_mm(12, -30, 50);
  const auto ray = camera.RayThrough(camera.Project(point_mm));
  ASSERT_TRUE(ray);
  EXPECT_THAT(ray->origin_mm + (point_mm - ray->origin_mm).norm() * ray->direction,
              PointNear(point_mm, 1e-9));
}

TEST(Render, PicturesShowTheSceneTheRightWayRound) {
  // From the front, the speaker's left is on the right of the picture, and up is up.
  const PinholeView camera({{0, 0, 1000}, {0, 0, 0}}, 100, 101, 101);
  EXPECT_THAT(camera.Project({0, 0, 0}), PixelNear(Eigen::Vector2d(50, 50), 1e-9));
  EXPECT_GT(camera.Project({10, 0, 0}).x(), 50);
  EXPECT_LT(camera.Project({0, 10, 0}).y(), 50);
}

TEST(Render, CoverageEqualsTheProjectedArea) {
  Scene scene = SilhouetteScene();
  scene.meshes.push_back(Square(30, Eigen::Vector3f::Ones()));
  const OrthographicView camera({{0, 0, 500}, {0, 0, 0}}, 100, 100, 100);
  const LinearPicture picture = RenderLinear(scene, camera, SilhouetteOptions());
  double covered_px = 0;
  for (const Eigen::Vector3f& light : picture.rgb) covered_px += light.x();
  EXPECT_NEAR(covered_px, 3600, 4 * 60 / 8.0);  // an eighth of a pixel along the outline
}

TEST(Render, LambertAndShadowsFollowTheLamp) {
  Scene scene;
  scene.ambient = Eigen::Vector3f::Zero();
  const double angle = 0.6;
  scene.lights = {{{std::sin(angle), 0, std::cos(angle)}, Eigen::Vector3f::Ones(), 0.0}};
  scene.meshes.push_back(Square(40, Eigen::Vector3f(0.5f, 0.25f, 1.0f)));
  const OrthographicView camera({{0, 0, 500}, {0, 0, 0}}, 60, 61, 61);
  const auto middle = [&] { return RenderLinear(scene, camera).rgb[30 * 61 + 30]; };
  const float cosine = static_cast<float>(std::cos(angle));
  EXPECT_NEAR((middle() - cosine * Eigen::Vector3f(0.5f, 0.25f, 1.0f)).norm(), 0, 1e-5);
  // A sphere between the middle and the lamp, outside the line of sight.
  scene.spheres.push_back(
      {100 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)), 8.0, Eigen::Vector3f::Ones()});
  EXPECT_NEAR(middle().norm(), 0, 1e-6);
}

TEST(Render, NearWallsKeepTheAmbientLightAway) {
  Scene scene;
  scene.lights.clear();
  scene.ambient = Eigen::Vector3f::Ones();
  scene.meshes.push_back(Square(200, Eigen::Vector3f::Ones()));
  RenderMesh wall = Square(200, Eigen::Vector3f::Ones());  // stands on the square at x = 10
  for (Eigen::Vector3d& vertex : wall.mesh.vertices)
    vertex = Eigen::Vector3d(10, vertex.y(), vertex.x());
  scene.meshes.push_back(wall);
  // Looking down on the square, close to the wall and 70 mm from it.
  const auto light_at = [&](double x) {
    const OrthographicView camera({{x, 0, 500}, {x, 0, 0}}, 1, 1, 1);
    return RenderLinear(scene, camera, {.samples_per_side = 40, .occlusion_mm = 1000}).rgb[0].x();
  };
  EXPECT_NEAR(light_at(9.4), 0.5, 0.02);
  // The form factor of an infinitely long wall of height h at distance d: (1 - d/sqrt(d^2+h^2))/2.
  const double distance = 70, height = 200;
  const double hidden = 0.5 * (1 - distance / std::hypot(distance, height));
  EXPECT_NEAR(light_at(-60), 1 - hidden,
              0.06);  // this wall ends at +-200 mm
}

TEST(Render, BytesDoNotDependOnThreadsOrRepetition) {
  Scene scene;
  scene.meshes.push_back(Square(30, Eigen::Vector3f(0.6f, 0.4f, 0.3f)));
  for (int i = 0; i < 12; ++i)
    scene.spheres.push_back({{4.0 * i - 20, 3.0 * (i % 5), 4}, 3, {0.2f, 0.5f, 0.7f}});
  const PinholeView camera({{80, 60, 300}, {0, 0, 0}}, 80, 96, 64);
  scene.mirrors.push_back({.center_mm = {0, 40, 10},
                           .normal = Eigen::Vector3d(0, 1, -1).normalized(),
                           .width_mm = 60,
                           .height_mm = 30});
  for (const double one_sample_below : {0.0, 0.01}) {
    RenderOptions options{.one_sample_below = one_sample_below, .num_threads = 1};
    const Picture once = Render(scene, camera, options);
    EXPECT_EQ(Render(scene, camera, options).rgb8, once.rgb8);
    options.num_threads = 3;
    EXPECT_EQ(Render(scene, camera, options).rgb8, once.rgb8);
  }
}

TEST(Render, PixelsThatSeeNothingShowTheBackground) {
  class BlindLens final : public ViewCamera {
   public:
    int width() const override { return 2; }
    int height() const override { return 1; }
    std::optional<SightRay> RayThrough(const Eigen::Vector2d& point_px) const override {
      if (point_px.x() < 0.5) return std::nullopt;
      return SightRay{{0, 0, 100}, {0, 0, -1}};
    }
  };
  Scene scene = SilhouetteScene();
  scene.background = Eigen::Vector3f(0.25f, 0.5f, 0.75f);
  scene.meshes.push_back(Square(10, Eigen::Vector3f::Ones()));
  const LinearPicture picture = RenderLinear(scene, BlindLens(), SilhouetteOptions());
  EXPECT_EQ(picture.rgb[0], scene.background);
  EXPECT_EQ(picture.rgb[1], Eigen::Vector3f(Eigen::Vector3f::Ones()));
}

// A lit ball and, in front of it, small bright dots.
Scene BallWithDots() {
  Scene scene;
  scene.spheres = {{{0, 0, 0}, 60.0, {0.5f, 0.4f, 0.35f}}};
  for (const double x_mm : {-31.3, -3.7, 22.9})
    scene.spheres.push_back({{x_mm, 10.2, 70}, 3.0, {0.9f, 0.9f, 0.9f}, {.gloss = 0, .glow = 1}});
  return scene;
}

RenderOptions AdaptiveOptions(int step_px) {
  return {.samples_per_side = 4,
          .one_sample_below = 0.004,
          .step_px = step_px,
          .occlusion_mm = 0,
          .shadows = false};
}

double RootMeanSquareOf(const LinearPicture& a, const LinearPicture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += (a.rgb[i] - b.rgb[i]).squaredNorm() / 3;
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

// Pixels that are left out are off by less than the threshold; those on edges, one in fifty, by the
// noise of 16 samples, some hundredths.
TEST(Render, FewSamplesWhereLittleChangesGiveThePictureOfMany) {
  const Scene scene = BallWithDots();
  const PinholeView camera({}, 200, 320, 240);
  const LinearPicture full =
      RenderLinear(scene, camera, {.samples_per_side = 12, .occlusion_mm = 0, .shadows = false});
  for (const int step_px : {1, 2, 4})
    EXPECT_LT(RootMeanSquareOf(RenderLinear(scene, camera, AdaptiveOptions(step_px)), full), 0.004)
        << step_px;
}

TEST(Render, SpotsAreSampledFinely) {
  Scene scene = BallWithDots();
  scene.spheres.erase(scene.spheres.begin());
  scene.lights.clear();
  scene.background = Eigen::Vector3f::Zero();
  const OrthographicView camera({}, 200, 320, 240);
  for (const RenderSphere& dot : scene.spheres) {
    Scene alone = scene;
    alone.spheres = {dot};
    RenderOptions options = AdaptiveOptions(16);
    options.samples_per_side = 1;
    options.spots = {{camera.Project(dot.center_mm), 3 * 240 / 200.0 + 2.5}};
    EXPECT_THAT(Centroid(RenderLinear(alone, camera, options)),
                PixelNear(camera.Project(dot.center_mm), 0.01));
  }
}

TEST(Render, BandsOfRowsMakeUpThePicture) {
  const Scene scene = BallWithDots();
  const PinholeView camera({}, 200, 160, 121);
  for (const double one_sample_below : {0.0, 0.004}) {
    RenderOptions options = AdaptiveOptions(4);
    options.one_sample_below = one_sample_below;
    const LinearPicture whole = RenderLinear(scene, camera, options);
    LinearPicture sum{160, 121, std::vector<Eigen::Vector3f>(whole.rgb.size())};
    for (Eigen::Vector3f& light : sum.rgb) light.setZero();
    for (const int first_row : {0, 37, 74, 111}) {
      options.first_row = first_row;
      options.end_row = first_row + 37;
      const LinearPicture band = RenderLinear(scene, camera, options);
      for (std::size_t i = 0; i < sum.rgb.size(); ++i) sum.rgb[i] += band.rgb[i];
    }
    EXPECT_EQ(RootMeanSquareOf(whole, sum), 0);
  }
}

}  // namespace
}  // namespace articap
