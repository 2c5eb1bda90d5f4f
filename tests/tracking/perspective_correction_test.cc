// SPDX-License-Identifier: MIT
#include "tracking/perspective_correction.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

#include "synthetic/random.h"
#include "tests/tracking/marker_outline.h"

namespace articap {
namespace {

Lens WideLens() {
  Lens lens{1500, 1480, 960, 540, {}};
  lens.distortion = {-0.15, 0.05, 0.001, -0.001, 0, 0, 0, 0};
  return lens;
}

Dot DotOf(const MarkerOutline& outline) {
  Dot dot;
  dot.center_px = outline.middle_px;
  dot.shape_px2 = outline.shape_px2;
  dot.covariance_px2.setZero();
  return dot;
}

// Towards somewhere in a picture of 1920 x 1080 px.
Eigen::Vector3d RandomCenter(RandomGenerator& random, const Lens& lens) {
  const double x_px = random.Uniform(100, 1800), y_px = random.Uniform(100, 980);
  return random.Uniform(250, 700) * Unproject(lens, {x_px, y_px})->normalized();
}

TEST(PerspectiveCorrectionTest, FindsTheMiddleOfBalls) {
  RandomGenerator random(5, 1);
  const Lens lens = WideLens();
  double before2 = 0, after2 = 0;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d center = RandomCenter(random, lens);
    const Eigen::Vector2d appears = *Project(lens, center);
    Dot dot = DotOf(OutlineOf(lens, HitsSphere(center, 5), appears));
    before2 += (dot.center_px - appears).squaredNorm();
    const Eigen::Vector2d measured = dot.center_px;
    const double moved_px = CorrectPerspective(lens, {MarkerKind::kSphere}, dot);
    EXPECT_NEAR(moved_px, (dot.center_px - measured).norm(), 1e-12);
    EXPECT_EQ(dot.covariance_px2, Eigen::Matrix2d::Zero());
    after2 += (dot.center_px - appears).squaredNorm();
  }
  std::printf("balls of 10 mm: RMS %.4f px, corrected %.6f px\n", std::sqrt(before2 / 40),
              std::sqrt(after2 / 40));
  EXPECT_GT(std::sqrt(before2 / 40), 0.03) << "there is something to correct";
  EXPECT_LT(after2, 0.01 * 0.01 * before2);
}

// The truth is one of the two ways in which the disc may be turned: half their distance off their
// mean, which is one standard deviation as the covariance has it.
TEST(PerspectiveCorrectionTest, OfDiscsSaysWhatItCannotKnow) {
  RandomGenerator random(6, 1);
  const Lens lens = WideLens();
  double before2 = 0, after2 = 0;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d center = RandomCenter(random, lens);
    const Eigen::Vector3d normal = -center.normalized() + 0.8 * random.Direction();
    const Eigen::Vector2d appears = *Project(lens, center);
    Dot dot = DotOf(OutlineOf(lens, HitsDisc(center, 4, normal), appears));
    before2 += (dot.center_px - appears).squaredNorm();
    CorrectPerspective(lens, {MarkerKind::kDisc}, dot);
    const Eigen::Vector2d left = dot.center_px - appears;
    after2 += left.squaredNorm();
    EXPECT_NEAR(left.norm(), std::sqrt(dot.covariance_px2.trace()), 1e-3 + 0.02 * left.norm());
  }
  std::printf("discs of 8 mm: RMS %.4f px, corrected %.4f px\n", std::sqrt(before2 / 40),
              std::sqrt(after2 / 40));
  EXPECT_LT(after2, before2);
}

TEST(PerspectiveCorrectionTest, WhatTheLensDoesNotShowStays) {
  Lens lens = WideLens();
  lens.distortion = {-0.5, 0, 0, 0, 0, 0, 0, 0};  // shows nothing beyond some 40 degrees
  Dot dot;
  dot.center_px = {9000, 9000};
  EXPECT_EQ(CorrectPerspective(lens, {}, dot), 0);
  EXPECT_EQ(dot.center_px, Eigen::Vector2d(9000, 9000));
}

}  // namespace
}  // namespace articap
