// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "render/render.h"
#include "render/traced_scene.h"

namespace articap {
namespace {

constexpr double kPixel_mm = 0.25;

// One pixel a quarter of a millimetre, from +z, the origin in the middle.
OrthographicView FromFront() { return OrthographicView({}, 20, 80, 80); }

RenderDisc Sticker(const Eigen::Vector3d& normal) {
  return {
      .center_mm = {0.31, -0.17, 0}, .normal = normal, .radius_mm = 2, .material = {.gloss = 0}};
}

// White stickers on black things: the light of a pixel is how much of it they cover.
Scene WithStickers(const std::vector<RenderDisc>& discs) {
  Scene scene;
  scene.discs = discs;
  scene.lights.clear();
  scene.ambient = Eigen::Vector3f::Ones();
  scene.background = Eigen::Vector3f::Zero();
  return scene;
}

struct Blob {
  double area_px2 = 0;
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
};

Blob BlobOf(const LinearPicture& picture) {
  Blob blob;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double light = picture.rgb[static_cast<std::size_t>(y) * picture.width + x].x();
      blob.area_px2 += light;
      blob.center_px += light * Eigen::Vector2d(x, y);
    }
  blob.center_px /= blob.area_px2;
  return blob;
}

Blob Look(const Scene& scene) {
  return BlobOf(RenderLinear(scene, FromFront(), {.samples_per_side = 8, .occlusion_mm = 0}));
}

RenderMesh BlackSquare(double half_mm, double z_mm) {
  RenderMesh square;
  square.mesh.vertices = {{-half_mm, -half_mm, z_mm},
                          {half_mm, -half_mm, z_mm},
                          {half_mm, half_mm, z_mm},
                          {-half_mm, half_mm, z_mm}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.colors.assign(4, Eigen::Vector3f::Zero());
  square.material = {.gloss = 0};
  return square;
}

// 8 x 8 samples leave an error of about a hundredth of a pixel's area in each of the 50 pixels on
// the edge: 0.002 px of the centre, 0.07 of some 200 px^2.
TEST(DiscTest, AStickerIsAnEllipseAroundItsCentre) {
  for (const double tilt_rad : {0.0, 0.6, 1.1}) {
    const RenderDisc sticker = Sticker({std::sin(tilt_rad), 0, std::cos(tilt_rad)});
    const Blob blob = Look(WithStickers({sticker}));
    const double area_px2 = std::numbers::pi * 4 * std::cos(tilt_rad) / (kPixel_mm * kPixel_mm);
    EXPECT_NEAR(blob.area_px2, area_px2, 0.3);
    EXPECT_LT((blob.center_px - FromFront().Project(sticker.center_mm)).norm(), 0.01);
  }
}

TEST(DiscTest, AStickerIsNotSeenFromBehind) {
  EXPECT_EQ(BlobOf(RenderLinear(WithStickers({Sticker(-Eigen::Vector3d::UnitZ())}), FromFront()))
                .area_px2,
            0);
}

TEST(DiscTest, WhatLiesUnderAStickerGivesWayToIt) {
  Scene scene = WithStickers({Sticker(Eigen::Vector3d::UnitZ())});
  const double whole_px2 = Look(scene).area_px2;
  for (const double z_mm : {-0.5, 0.0, 0.9}) {
    scene.meshes = {BlackSquare(8, z_mm)};
    EXPECT_NEAR(Look(scene).area_px2, whole_px2, 0.3) << "a surface at " << z_mm << " mm";
  }
  scene.meshes = {BlackSquare(8, 1.1)};
  EXPECT_EQ(Look(scene).area_px2, 0) << "more than it gives";
}

// 45 degrees from the side, a wall before the sticker hides it, though lower than what gives way
// beneath: it does not stand under it.
TEST(DiscTest, WhatStandsBeforeAStickerHidesIt) {
  Scene scene = WithStickers({{.radius_mm = 2, .give_mm = 0.5}});
  RenderMesh wall;
  wall.mesh.vertices = {{3, -9, -5}, {3, 9, -5}, {3, 9, 0.4}, {3, -9, 0.4}};
  wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  wall.colors.assign(4, Eigen::Vector3f::Zero());
  scene.meshes = {wall};
  const TracedScene traced(scene);
  const auto sees = [&](double x_mm) {
    const Eigen::Vector3d direction = Eigen::Vector3d(-20, 0, -1).normalized();
    const SightEnd end = traced.Follow({Eigen::Vector3d(x_mm, 0, 0) - 50 * direction, direction});
    return end.surface && end.surface->disc == 0;
  };
  EXPECT_FALSE(sees(1.5)) << "the ray passes the wall 0.075 mm over the sticker's plane";
  scene.meshes.clear();
  const TracedScene open(scene);
  const Eigen::Vector3d direction = Eigen::Vector3d(-20, 0, -1).normalized();
  const SightEnd end = open.Follow({Eigen::Vector3d(1.5, 0, 0) - 50 * direction, direction});
  ASSERT_TRUE(end.surface);
  EXPECT_EQ(end.surface->disc, 0);
}

TEST(DiscTest, ShadowsDoNotFallFromStickers) {
  Scene scene = WithStickers({Sticker(Eigen::Vector3d::UnitZ())});
  const TracedScene traced(scene);
  EXPECT_FALSE(traced.IsBlocked({0, 0, -5}, {0, 0, 1}));
}

}  // namespace
}  // namespace articap
