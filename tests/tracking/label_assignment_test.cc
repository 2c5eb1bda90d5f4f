// SPDX-License-Identifier: MIT
#include "tracking/label_assignment.h"

#include <gtest/gtest.h>

#include <cmath>

namespace articap {
namespace {

constexpr int kDirect = -1, kMirror = 0;

CloudPoint Point(const Eigen::Vector3d& position_mm, const Eigen::Vector3d& sigmas_mm,
                 std::vector<DotSight> sights) {
  CloudPoint point;
  point.position_in_stage_mm = position_mm;
  point.covariance_mm2 = sigmas_mm.cwiseAbs2().asDiagonal();
  point.sights = std::move(sights);
  return point;
}

// A marker that is expected at the origin. Both views see it at (2.5, 0.2, 0); the mirror, alone,
// somewhere along x.
class SuddenMove : public testing::Test {
 protected:
  LabelPriors priors_ = {.usual = {.seen = 0.95, .seen_by_one_view = 0.01}};
  const std::vector<MarkerPlace> places_ = {
      {Eigen::Vector3d::Zero(), 0.4 * 0.4 * Eigen::Matrix3d::Identity()}};
  const std::vector<CloudPoint> cloud_ = {
      Point({2.5, 0.2, 0}, {0.02, 0.02, 0.02}, {{{0, kDirect}, 4}, {{0, kMirror}, 7}}),
      Point({-20, 0.2, 0}, {70, 0.1, 0.1}, {{{0, kMirror}, 7}})};

  std::vector<int> Assigned() const {
    const auto pose = PoseEstimate::Isotropic(Rigid3d(), Eigen::Vector3d::Zero(), 1e-4, 1e-2);
    return AssignPoints(CostsOf(places_, cloud_, pose, priors_), cloud_);
  }
};

TEST_F(SuddenMove, ALoneRayIsNearerThanItIs) { EXPECT_EQ(Assigned(), std::vector{1}); }

TEST_F(SuddenMove, WhatMovesSuddenlyAtTimesIsBelievedToHaveMoved) {
  priors_.sudden = 0.02;
  EXPECT_EQ(Assigned(), std::vector{0});
}

TEST_F(SuddenMove, CostsAreOfTheSumOfBothDensities) {
  priors_.sudden = 0.1;
  const auto pose = PoseEstimate::Isotropic(Rigid3d(), Eigen::Vector3d::Zero(), 1e-9, 1e-9);
  LabelPriors plain = priors_;
  plain.sudden = 0;
  std::vector<MarkerPlace> wide = places_;
  wide[0].covariance_mm2 *= 16;
  const double usual = CostsOf(places_, cloud_, pose, plain)(0, 0);
  const double sudden = CostsOf(wide, cloud_, pose, plain)(0, 0);
  EXPECT_NEAR(CostsOf(places_, cloud_, pose, priors_)(0, 0),
              -2 * std::log(0.9 * std::exp(-usual / 2) + 0.1 * std::exp(-sudden / 2)), 1e-9);
}

// 0.6 mm off where 0.4 mm are usual is no reason to doubt that both views see it, as they always
// do.
TEST(LabelAssignmentTest, EveryMarkerHasItsOwnHistory) {
  const std::vector<MarkerPlace> places(
      2, {Eigen::Vector3d::Zero(), 0.4 * 0.4 * Eigen::Matrix3d::Identity()});
  const std::vector<CloudPoint> cloud = {Point({0.6, 0, 0}, {70, 0.1, 0.1}, {{{0, kMirror}, 7}})};
  const auto pose = PoseEstimate::Isotropic(Rigid3d(), Eigen::Vector3d::Zero(), 1e-4, 1e-2);
  LabelPriors priors;
  priors.markers = {{0.9, 0.01}, {0.5, 0.8}};
  const LabelCosts costs = CostsOf(places, cloud, pose, priors);
  // Odds of showing something, and to one view alone.
  EXPECT_NEAR(costs(0, 0) - costs(1, 0), 2 * std::log((0.8 * 1) / (0.01 * 9)), 1e-9);
  EXPECT_EQ(AssignPoints(costs, cloud), (std::vector{-1, 0}));
}

}  // namespace
}  // namespace articap
