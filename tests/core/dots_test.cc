// SPDX-License-Identifier: MIT
#include "core/dots.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace articap {
namespace {

TEST(Dot, SizeAndRoundnessOfATurnedEllipse) {
  Dot dot;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.7).toRotationMatrix();
  dot.shape_px2 = turn * Eigen::Vector2d(5 * 5, 4 * 4).asDiagonal() * turn.transpose();
  EXPECT_NEAR(dot.roundness(), 0.8, 1e-12);
  EXPECT_NEAR(dot.diameter_px(), 2 * std::sqrt(5.0 * 4.0), 1e-12);
}

TEST(Dot, ADiscIsRound) {
  Dot dot;
  dot.shape_px2 = 9 * Eigen::Matrix2d::Identity();
  EXPECT_DOUBLE_EQ(dot.roundness(), 1);
  EXPECT_DOUBLE_EQ(dot.diameter_px(), 6);
}

}  // namespace
}  // namespace articap
