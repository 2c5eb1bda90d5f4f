// SPDX-License-Identifier: MIT
#include "tracking/rigidity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/statistics.h"

namespace articap {
namespace {

TEST(SpreadFramesTest, CoversTheTake) {
  EXPECT_THAT(SpreadFrames(3, 10), testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(SpreadFrames(101, 5), testing::ElementsAre(0, 25, 50, 75, 100));
  EXPECT_THAT(SpreadFrames(0, 5), testing::IsEmpty());
}

// Two thousand frames know the width of a distribution to some 3 %, the variance of a pair with the
// bad marker (0.68 mm^2) thus to 0.04 mm^2; a quarter of that may turn up in a good one's 0.04.
TEST(DistanceStatisticsTest, SplitsTheNoiseAmongTheMarkers) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const std::vector<Eigen::Vector3d> places_mm = {
      {0, 0, 0}, {60, 0, 0}, {0, 50, 0}, {0, 0, 70}, {40, 40, 40}};
  const std::vector<double> sigmas_mm = {0.2, 0.2, 0.2, 0.2, 0.8};
  StageTracks tracks({"a", "b", "c", "d", "e", "never"}, 2000, 60);
  for (int frame = 0; frame < 2000; ++frame) {
    const Eigen::Quaterniond rotation =
        Eigen::Quaterniond{normal(random), normal(random), normal(random), normal(random)}
            .normalized();
    for (int i = 0; i < 5; ++i) {
      Eigen::Vector3d noise_mm{normal(random), normal(random), normal(random)};
      noise_mm *= uniform(random) < 0.02 ? 10 : sigmas_mm[i];  // outliers must not count
      tracks.Set(frame, i, rotation * (places_mm[i] + noise_mm));
    }
  }
  const std::vector<int> columns = {0, 1, 2, 3, 4, 5};
  const auto statistics = MeasureDistances(tracks, columns, SpreadFrames(2000, 2000), false);
  EXPECT_NEAR(statistics.median_mm(0, 1), 60, 0.05);
  EXPECT_EQ(statistics.num_frames(3, 4), 2000);
  EXPECT_TRUE(std::isnan(statistics.variance_mm2(2, 5)));
  const std::vector<int> members = {0, 1, 2, 3, 4};
  const auto found_mm = SigmasOfMembers(statistics.variance_mm2, members);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found_mm[i], sigmas_mm[i], 0.08) << i;
  EXPECT_NEAR(found_mm[4], sigmas_mm[4], 0.08);
  const auto weighting_mm = WeightingSigmas(found_mm);
  EXPECT_EQ(weighting_mm[4], found_mm[4]);
  for (int i = 0; i < 4; ++i) EXPECT_GE(weighting_mm[i], MedianOf(found_mm));
}

TEST(SigmasOfMembersTest, AssumesWhereNothingIsKnown) {
  const Eigen::MatrixXd unknown =
      Eigen::MatrixXd::Constant(3, 3, std::numeric_limits<double>::quiet_NaN());
  for (const double sigma_mm : SigmasOfMembers(unknown, std::vector<int>{0, 1, 2}))
    EXPECT_NEAR(sigma_mm, kAssumedSigmaMm, 1e-9);
}

}  // namespace
}  // namespace articap
