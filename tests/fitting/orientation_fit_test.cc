// SPDX-License-Identifier: MIT
#include "fitting/orientation_fit.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/matchers.h"

namespace articap {
namespace {

const Sim3d kTruth = Sim3d::FromParameters({3, -8, 12, 0.1, -0.2, 0.05, 0.93});

// Strategic points of a face, as measured where the truth puts them, with noise of the head.
std::vector<PointPair> MakePairs(double sigma_mm = 0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma_mm);
  std::vector<PointPair> pairs;
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 0),
                                       {0, -45, 22},
                                       {27, -72, 5},
                                       {-27, -72, 5},
                                       {0, -105, 8},
                                       {0, -62, 17},
                                       {45, 25, -8},
                                       {-45, 25, -8}})
    pairs.push_back({"p" + std::to_string(pairs.size()),
                     point + Eigen::Vector3d{noise(random), noise(random), noise(random)},
                     kTruth * point});
  return pairs;
}

TEST(OrientationFitTest, ExactPointsGiveTheTruth) {
  for (const FitMetric metric : {FitMetric::kDistance, FitMetric::kSquared, FitMetric::kHuber}) {
    const OrientationFit fit = FitOrientation(MakePairs(), {.metric = metric});
    EXPECT_TRUE(fit.converged);
    EXPECT_THAT(fit.rig_from_head, Sim3dNear(kTruth, 1e-6, 1e-4, 1e-6));
    for (const double residual_mm : fit.residuals_mm) EXPECT_LT(residual_mm, 1e-3);
  }
}

// One marker named wrongly: the sum of distances hardly follows it, the sum of squares does.
TEST(OrientationFitTest, DistancesResistAnOutlier) {
  std::vector<PointPair> pairs = MakePairs(0.3);
  pairs[4].point_in_head += Eigen::Vector3d(20, 15, 0);
  const auto error_mm = [&](FitMetric metric) {
    const OrientationFit fit = FitOrientation(pairs, {.metric = metric});
    double largest = 0;
    for (const PointPair& truth : MakePairs())
      largest =
          std::max(largest, (fit.rig_from_head * truth.point_in_head - truth.point_in_rig).norm());
    return largest;
  };
  EXPECT_LT(error_mm(FitMetric::kDistance), 2);
  EXPECT_GT(error_mm(FitMetric::kSquared), 5);
}

TEST(OrientationFitTest, TheStartDoesNotMatter) {
  const std::vector<PointPair> pairs = MakePairs(0.5);
  const OrientationFit from_closed_form = FitOrientation(pairs, {});
  const OrientationFit from_afar =
      FitOrientation(pairs, {}, Sim3d::FromParameters({60, 20, -30, 0.5, 0.4, -0.6, 1.4}));
  EXPECT_NEAR(from_afar.objective, from_closed_form.objective, 1e-6 * from_closed_form.objective);
  EXPECT_THAT(from_afar.rig_from_head, Sim3dNear(from_closed_form.rig_from_head, 1e-4, 0.02, 1e-4));
}

TEST(OrientationFitTest, ThreePointsAreEnough) {
  std::vector<PointPair> pairs = MakePairs();
  pairs.resize(3);
  EXPECT_THAT(FitOrientation(pairs, {}).rig_from_head, Sim3dNear(kTruth, 1e-6, 1e-4, 1e-6));
}

}  // namespace
}  // namespace articap
