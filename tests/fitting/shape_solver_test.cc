// SPDX-License-Identifier: MIT
#include "fitting/shape_solver.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "fitting/ceres_shape_solver.h"
#include "fitting/cost_functions/virtual_marker_cost.h"
#include "tests/rig/toy_rig.h"
#include "tests/support/matchers.h"

namespace articap {
namespace {

struct Scene {
  FaceRig rig = MakeToyRig();
  std::vector<VirtualMarker> markers;
  Eigen::VectorXd lower, upper;

  Scene() {
    const auto& triangles = rig.neutral_mesh().triangles;
    for (std::size_t i = 5; i < triangles.size(); i += 18)
      markers.push_back({"m" + std::to_string(i), triangles[i], 0.3, 0.2, 2});
    lower.resize(rig.num_parameters());
    upper.resize(rig.num_parameters());
    for (int i = 0; i < rig.num_parameters(); ++i) {
      lower[i] = rig.definition().parameters[i].min;
      upper[i] = rig.definition().parameters[i].max;
    }
  }

  Eigen::VectorXd RandomPose(std::mt19937& random, double part_of_range) const {
    Eigen::VectorXd pose(lower.size());
    for (int i = 0; i < pose.size(); ++i) {
      const double at = std::uniform_real_distribution<double>(0, 1)(random);
      pose[i] = part_of_range * (lower[i] + at * (upper[i] - lower[i]));
    }
    return pose;
  }

  std::vector<Eigen::Vector3d> Measure(const VirtualMarkerEvaluator& evaluator,
                                       const Eigen::VectorXd& pose, double sigma_mm,
                                       std::mt19937& random) const {
    std::normal_distribution<double> noise(0, sigma_mm);
    const Eigen::Matrix3Xd positions =
        evaluator.Positions({pose.data(), static_cast<std::size_t>(pose.size())});
    std::vector<Eigen::Vector3d> measured;
    for (int i = 0; i < positions.cols(); ++i)
      measured.push_back(positions.col(i) +
                         Eigen::Vector3d{noise(random), noise(random), noise(random)});
    return measured;
  }
};

TEST(VirtualMarkerCostTest, GradientIsRight) {
  const Scene scene;
  const VirtualMarkerEvaluator evaluator(scene.rig, scene.markers);
  std::mt19937 random(5);
  const Eigen::VectorXd pose = scene.RandomPose(random, 0.8);
  const int num_parameters = evaluator.num_parameters();
  // Central differences; ceres::GradientChecker knows relative errors alone, and most entries are
  // zero.
  const double h = 1e-5;
  for (int marker = 0; marker < evaluator.num_markers(); ++marker) {
    const VirtualMarkerCost cost(evaluator, marker, Eigen::Vector3d(1, 2, 3));
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> jacobian(3, num_parameters);
    Eigen::Vector3d residual, ahead, behind;
    const double* parameters[] = {pose.data()};
    double* jacobians[] = {jacobian.data()};
    ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), jacobians));
    for (int k = 0; k < num_parameters; ++k) {
      Eigen::VectorXd moved = pose;
      const double* moved_parameters[] = {moved.data()};
      moved[k] = pose[k] + h;
      cost.Evaluate(moved_parameters, ahead.data(), nullptr);
      moved[k] = pose[k] - h;
      cost.Evaluate(moved_parameters, behind.data(), nullptr);
      EXPECT_THAT(jacobian.col(k), PointNear((ahead - behind) / (2 * h), 1e-6))
          << marker << ", " << k;
    }
  }
}

struct SolverCase {
  FitMetric metric;
  double sigma_mm;
  double part_of_range;  // above 1, the truth lies outside the box
  bool with_gaps;
};

class ShapeSolverAgainstCeres : public testing::TestWithParam<SolverCase> {};

TEST_P(ShapeSolverAgainstCeres, ReachesTheSameObjective) {
  const Scene scene;
  const VirtualMarkerEvaluator evaluator(scene.rig, scene.markers);
  const MarkerLoss loss{GetParam().metric, 0.001, 0.5};
  ShapeSolver solver(evaluator, scene.lower, scene.upper, {.loss = loss});
  const LinearizedFrame linearized(evaluator, loss);
  std::mt19937 random(21);
  int evaluations = 0;
  constexpr int kNumFrames = 100;
  for (int frame = 0; frame < kNumFrames; ++frame) {
    const Eigen::VectorXd truth = scene.RandomPose(random, GetParam().part_of_range);
    auto measured = scene.Measure(evaluator, truth, GetParam().sigma_mm, random);
    if (GetParam().with_gaps)
      for (std::size_t i = frame % 3; i < measured.size(); i += 3)
        measured[i].setConstant(std::numeric_limits<double>::quiet_NaN());

    Eigen::VectorXd ours = Eigen::VectorXd::Zero(scene.lower.size());
    Eigen::VectorXd reference = ours;
    const ShapeSolution solution = solver.Solve(measured, &ours);
    const ShapeSolution expected =
        SolveShapeWithCeres(evaluator, scene.lower, scene.upper, loss, measured, &reference);
    EXPECT_TRUE(solution.converged) << "frame " << frame;
    const double found = linearized.Objective(measured, ours);
    EXPECT_LE(found, expected.objective * (1 + 1e-6) + 1e-9) << "frame " << frame;
    EXPECT_GE(found, expected.objective * (1 - 1e-6) - 1e-9) << "frame " << frame;
    EXPECT_NEAR(solution.objective, found, 1e-7 * found + 1e-9) << "frame " << frame;
    evaluations += solution.evaluations;
  }
  RecordProperty("evaluations_per_frame", std::to_string(1.0 * evaluations / kNumFrames));
}

INSTANTIATE_TEST_SUITE_P(Cases, ShapeSolverAgainstCeres,
                         testing::Values(SolverCase{FitMetric::kDistance, 0.2, 0.9, false},
                                         SolverCase{FitMetric::kDistance, 0.2, 1.3, false},
                                         SolverCase{FitMetric::kDistance, 2.0, 0.9, true},
                                         SolverCase{FitMetric::kDistance, 0.0, 0.9, false},
                                         SolverCase{FitMetric::kSquared, 0.2, 1.3, true},
                                         SolverCase{FitMetric::kHuber, 0.5, 1.3, true}));

}  // namespace
}  // namespace articap
