// SPDX-License-Identifier: MIT
#include "tracking/perspective_bias.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "synthetic/random.h"
#include "tests/tracking/marker_outline.h"

namespace articap {
namespace {

Lens PlainLens() { return {1500, 1480, 960, 540, {}}; }

// Towards somewhere in a picture of 1920 x 1080 px.
Eigen::Vector3d RandomCenter(RandomGenerator& random, const Lens& lens) {
  const Eigen::Vector2d at{random.Uniform(100, 1800), random.Uniform(100, 980)};
  return random.Uniform(250, 700) * Unproject(lens, at)->normalized();
}

TEST(PerspectiveBiasTest, IsExactForSpheres) {
  RandomGenerator random(1, 1);
  const Lens lens = PlainLens();
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d center = RandomCenter(random, lens);
    const double diameter_mm = random.Uniform(2, 15);
    const Eigen::Vector2d appears = *Project(lens, center);
    const Eigen::Vector2d truth =
        OutlineOf(lens, HitsSphere(center, diameter_mm / 2), appears).middle_px - appears;
    const auto bias = PerspectiveBias(lens, center, {MarkerKind::kSphere, diameter_mm, {}});
    ASSERT_TRUE(bias);
    EXPECT_LT((*bias - truth).norm(), 1e-6 + 1e-4 * truth.norm());
  }
}

TEST(PerspectiveBiasTest, IsExactForDiscs) {
  RandomGenerator random(2, 1);
  const Lens lens = PlainLens();
  double largest_px = 0;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d center = RandomCenter(random, lens);
    const double diameter_mm = random.Uniform(2, 12);
    // Up to some 60 degrees aslant.
    const Eigen::Vector3d normal = -center.normalized() + 0.8 * random.Direction();
    const Eigen::Vector2d appears = *Project(lens, center);
    const Eigen::Vector2d truth =
        OutlineOf(lens, HitsDisc(center, diameter_mm / 2, normal), appears).middle_px - appears;
    const auto bias = PerspectiveBias(lens, center, {MarkerKind::kDisc, diameter_mm, normal});
    ASSERT_TRUE(bias);
    EXPECT_LT((*bias - truth).norm(), 1e-6 + 1e-4 * truth.norm());
    largest_px = std::max(largest_px, truth.norm());
  }
  EXPECT_GT(largest_px, 0.1) << "there is something to correct";
}

TEST(PerspectiveBiasTest, DistortionBendsTheOutline) {
  RandomGenerator random(3, 1);
  Lens lens = PlainLens();
  lens.distortion = {-0.15, 0.05, 0.001, -0.001, 0, 0, 0, 0};
  double sum2 = 0, left2 = 0;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d center = RandomCenter(random, lens);
    const Eigen::Vector3d normal = -center.normalized() + 0.8 * random.Direction();
    const Eigen::Vector2d appears = *Project(lens, center);
    const Eigen::Vector2d truth =
        OutlineOf(lens, HitsDisc(center, 4, normal), appears).middle_px - appears;
    const auto bias = PerspectiveBias(lens, center, {MarkerKind::kDisc, 8, normal});
    ASSERT_TRUE(bias);
    sum2 += truth.squaredNorm();
    left2 += (*bias - truth).squaredNorm();
  }
  std::printf("with distortion, discs of 8 mm: RMS offset %.4f px, of which %.6f px are left\n",
              std::sqrt(sum2 / 30), std::sqrt(left2 / 30));
  EXPECT_LT(left2, 0.01 * 0.01 * sum2);
}

TEST(PerspectiveBiasTest, WhatIsNotAllAheadHasNone) {
  const Lens lens = PlainLens();
  EXPECT_FALSE(PerspectiveBias(lens, {0, 0, -100}, {}));
  EXPECT_FALSE(PerspectiveBias(lens, {0, 0, 4}, {MarkerKind::kSphere, 10, {}}));
  EXPECT_FALSE(PerspectiveBias(lens, {0, 0, 4}, {MarkerKind::kDisc, 10, Eigen::Vector3d::UnitX()}));
}

}  // namespace
}  // namespace articap
