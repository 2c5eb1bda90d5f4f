// SPDX-License-Identifier: MIT
#include "tracking/perspective_bias.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "synthetic/random.h"

namespace articap {
namespace {

using Hits = std::function<bool(const Eigen::Vector3d& direction)>;

Hits HitsSphere(const Eigen::Vector3d& center_mm, double radius_mm) {
  return [=](const Eigen::Vector3d& direction) {
    return direction.normalized().cross(center_mm).norm() < radius_mm;
  };
}

Hits HitsDisc(const Eigen::Vector3d& center_mm, double radius_mm, const Eigen::Vector3d& normal) {
  return [=](const Eigen::Vector3d& direction) {
    const double distance = normal.dot(center_mm) / normal.dot(direction);
    return distance > 0 && (distance * direction - center_mm).norm() < radius_mm;
  };
}

// The middle of what rays of sight through the picture meet: its border is sought in 720 directions
// from a point inside.
Eigen::Vector2d MiddleOf(const Lens& lens, const Hits& hits, const Eigen::Vector2d& inside_px) {
  constexpr int kDirections = 720;
  std::vector<Eigen::Vector2d> border;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double near_px = 0, far_px = 500;
    for (int step = 0; step < 60; ++step) {
      const double middle_px = (near_px + far_px) / 2;
      const auto ray = Unproject(lens, inside_px + middle_px * direction);
      (ray && hits(*ray) ? near_px : far_px) = middle_px;
    }
    border.push_back(near_px * direction);
  }
  // Of the polygon's area.
  double area = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < border.size(); ++i) {
    const Eigen::Vector2d& a = border[i];
    const Eigen::Vector2d& b = border[(i + 1) % border.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross;
    sum += cross * (a + b) / 3;
  }
  return inside_px + sum / area;
}

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
        MiddleOf(lens, HitsSphere(center, diameter_mm / 2), appears) - appears;
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
        MiddleOf(lens, HitsDisc(center, diameter_mm / 2, normal), appears) - appears;
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
    const Eigen::Vector2d truth = MiddleOf(lens, HitsDisc(center, 4, normal), appears) - appears;
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
