// SPDX-License-Identifier: MIT
#include "core/alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/matchers.h"

namespace articap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points RandomPoints(std::mt19937& random, int count) {
  std::normal_distribution<double> coordinate(0, 40);
  Points points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

Sim3d RandomSimilarity(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond rotation{normal(random), normal(random), normal(random), normal(random)};
  return {std::exp(0.3 * normal(random)), rotation.normalized(), RandomPoints(random, 1)[0]};
}

template <class Transform>
Points Moved(const Transform& target_from_source, const Points& points) {
  Points moved;
  for (const Eigen::Vector3d& point : points) moved.push_back(target_from_source * point);
  return moved;
}

Points WithNoise(std::mt19937& random, Points points, double sigma_mm) {
  std::normal_distribution<double> noise(0, sigma_mm);
  for (Eigen::Vector3d& point : points)
    point += Eigen::Vector3d{noise(random), noise(random), noise(random)};
  return points;
}

Points Mirrored(Points points) {
  for (Eigen::Vector3d& point : points) point.x() *= -1;
  return points;
}

TEST(AlignmentTest, ExactPairsGiveTheTransform) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Points source = RandomPoints(random, 3 + i % 6);
    const Sim3d truth = RandomSimilarity(random);
    EXPECT_THAT(AlignSimilarity(source, Moved(truth, source)), Sim3dNear(truth, 1e-7, 1e-9, 1e-12));
    const Rigid3d rigid{truth.rotation, truth.translation_mm};
    EXPECT_THAT(AlignRigid(source, Moved(rigid, source)), Rigid3dNear(rigid, 1e-7, 1e-9));
  }
}

TEST(AlignmentTest, WeightZeroLeavesOutEvenNaN) {
  std::mt19937 random(2);
  Points source = RandomPoints(random, 6);
  const Sim3d truth = RandomSimilarity(random);
  Points target = Moved(truth, source);
  target[1] = Eigen::Vector3d(1000, 0, 0);
  target[4].setConstant(std::numeric_limits<double>::quiet_NaN());
  source[5].setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> weights = {1, 0, 2, 0.5, 0, 0};
  EXPECT_THAT(AlignSimilarity(source, target, weights), Sim3dNear(truth, 1e-7, 1e-9, 1e-12));
  EXPECT_NEAR(AlignmentRms(truth, source, target, weights), 0, 1e-9);
}

TEST(AlignmentTest, LeastSquaresIsAMinimum) {
  std::mt19937 random(3);
  const Points source = RandomPoints(random, 5);
  const Points target = WithNoise(random, Moved(RandomSimilarity(random), source), 2.0);
  const std::vector<double> weights = {1, 4, 0.3, 2, 1};
  const Sim3d best = AlignSimilarity(source, target, weights);
  const double best_rms = AlignmentRms(best, source, target, weights);
  std::normal_distribution<double> step(0, 1e-3);
  for (int i = 0; i < 200; ++i) {
    std::array<double, 7> x = best.ToParameters();
    for (double& value : x) value += step(random);
    EXPECT_GT(AlignmentRms(Sim3d::FromParameters(x), source, target, weights), best_rms);
  }
}

TEST(AlignmentTest, NeverReflects) {
  std::mt19937 random(4);
  for (int i = 0; i < 50; ++i) {
    const Points source = RandomPoints(random, 8);
    const Points target = Moved(RandomSimilarity(random), Mirrored(source));
    const Sim3d found = AlignSimilarity(source, target);
    EXPECT_NEAR(found.rotation.toRotationMatrix().determinant(), 1, 1e-12);
    EXPECT_GT(AlignmentRms(found, source, target), 1);
  }
}

TEST(AlignmentTest, DetectsReflections) {
  std::mt19937 random(5);
  const Points source = RandomPoints(random, 8);
  const Sim3d truth = RandomSimilarity(random);
  const ReflectionTest proper =
      DetectReflection(source, WithNoise(random, Moved(truth, source), 0.5));
  EXPECT_FALSE(proper.is_reflected);
  const ReflectionTest mirrored =
      DetectReflection(source, WithNoise(random, Moved(truth, Mirrored(source)), 0.5));
  EXPECT_TRUE(mirrored.is_reflected);
  EXPECT_LT(mirrored.rms_reflected, 2);
}

TEST(AlignmentTest, PlanarPointsAreNeverCalledReflected) {
  std::mt19937 random(6);
  Points source = RandomPoints(random, 8);
  for (Eigen::Vector3d& point : source) point.z() = 0;
  const Sim3d truth = RandomSimilarity(random);
  EXPECT_FALSE(DetectReflection(source, Moved(truth, source)).is_reflected);
  EXPECT_FALSE(DetectReflection(source, WithNoise(random, Moved(truth, source), 0.5)).is_reflected);
}

TEST(AlignmentTest, DegeneratePairsGiveAFiniteRotation) {
  const Points one = {{1, 2, 3}};
  EXPECT_THAT(AlignRigid(one, Points{{4, 6, 8}}),
              Rigid3dNear(Rigid3d{{1, 0, 0, 0}, {3, 4, 5}}, 1e-12, 1e-12));
  const Points line = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}};
  const Rigid3d truth{Eigen::Quaterniond(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitY())),
                      {1, 2, 3}};
  const Rigid3d found = AlignRigid(line, Moved(truth, line));
  EXPECT_NEAR(AlignmentRms(found, line, Moved(truth, line)), 0, 1e-9);
  EXPECT_TRUE(std::isinf(SpreadOf(line).WorstRotationSigma()));
}

// First-order covariances against a Monte Carlo: 2000 trials know a standard deviation to 1/sqrt(2
// * 2000 * 2) = 1.1 %, and the worst angle is one of three; 5 % is beyond four sigmas.
TEST(AlignmentTest, PredictsItsOwnErrors) {
  std::mt19937 random(7);
  const Points source = {{-70, 0, -20}, {-30, 5, 0}, {0, -5, 10}, {30, 5, 0}, {70, 0, -20}};
  const double sigma_mm = 0.2;
  const std::vector<double> weights(source.size(), 1 / (sigma_mm * sigma_mm));
  const PointSpread spread = SpreadOf(source, weights);
  EXPECT_NEAR(WorstRotationSigma(source, weights) / spread.WorstRotationSigma(), 1, 1e-9);
  const Eigen::Vector3d chin(0, -110, 0);
  double placement = 0, worst_angle = 0;
  const int num_trials = 2000;
  for (int trial = 0; trial < num_trials; ++trial) {
    const Rigid3d found = AlignRigid(source, WithNoise(random, source, sigma_mm));
    placement += (found * chin - chin).squaredNorm();
    const double angle = 2 * found.rotation.vec().dot(spread.axes.col(0));
    worst_angle += angle * angle;
  }
  EXPECT_NEAR(std::sqrt(placement / num_trials) / spread.PlacementSigma(chin), 1, 0.05);
  EXPECT_NEAR(std::sqrt(worst_angle / num_trials) / spread.WorstRotationSigma(), 1, 0.07);
}

}  // namespace
}  // namespace articap
