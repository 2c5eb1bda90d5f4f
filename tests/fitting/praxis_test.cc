// SPDX-License-Identifier: MIT
// Both fits against PRAXIS, the kept descendant of the direction-set method that the paper used:
// same evaluator, same start, no bounds.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "fitting/orientation_fit.h"
#include "fitting/shape_solver.h"
#include "tests/support/praxis.h"
#include "tests/support/speech_scene.h"

namespace articap {
namespace {

constexpr int kNumFrames = 200;

// Ours may be worse by rounding alone.
double Allowed(double praxis_objective) { return praxis_objective * (1 + 1e-6) + 1e-9; }

TEST(PraxisTest, ShapeFitIsNeverWorse) {
  const SpeechScene scene = MakeSpeechScene(2, 0.2);
  const VirtualMarkerEvaluator evaluator(scene.rig, scene.markers);
  const int num_parameters = evaluator.num_parameters();
  const Eigen::VectorXd unbounded =
      Eigen::VectorXd::Constant(num_parameters, std::numeric_limits<double>::infinity());
  const MarkerLoss loss;
  ShapeSolver solver(evaluator, -unbounded, unbounded, {.loss = loss});
  LinearizedFrame linearized(evaluator, loss);
  std::vector<double> steps;
  for (int k = 0; k < num_parameters; ++k)
    steps.push_back(0.05 * (scene.upper[k] - scene.lower[k]));

  ASSERT_GE(scene.measured.size(), kNumFrames);
  double worst = -1;
  for (int i = 0; i < kNumFrames; ++i) {
    const auto& measured = scene.measured[i * scene.measured.size() / kNumFrames];
    Eigen::VectorXd ours = Eigen::VectorXd::Zero(num_parameters);
    solver.Solve(measured, &ours);
    const double objective = linearized.Objective(measured, ours);
    std::vector<double> x(num_parameters, 0.0);
    const PraxisResult praxis = MinimizeWithPraxis(
        [&](const std::vector<double>& y) {
          return linearized.Objective(measured,
                                      Eigen::Map<const Eigen::VectorXd>(y.data(), num_parameters));
        },
        steps, 20000, &x);
    EXPECT_LE(objective, Allowed(praxis.objective)) << "frame " << i;
    worst = std::max(worst, objective / praxis.objective - 1);
  }
  RecordProperty("worst_excess_over_praxis", std::to_string(worst));
}

TEST(PraxisTest, OrientationFitIsNeverWorse) {
  std::mt19937 random(31);
  std::normal_distribution<double> normal;
  double worst = -1;
  for (int frame = 0; frame < kNumFrames; ++frame) {
    const Sim3d truth = Sim3d::FromParameters(
        {10 * normal(random), 10 * normal(random), 10 * normal(random), 0.4 * normal(random),
         0.4 * normal(random), 0.4 * normal(random), 1 + 0.1 * normal(random)});
    std::vector<PointPair> pairs;
    for (int i = 0; i < 7; ++i) {
      const Eigen::Vector3d in_head(40 * normal(random), 40 * normal(random), 20 * normal(random));
      const Eigen::Vector3d error(3 * normal(random), 3 * normal(random), 3 * normal(random));
      pairs.push_back({"p" + std::to_string(i), in_head, truth * in_head + error});
    }
    const MarkerLoss loss;
    const Sim3d start;
    const OrientationFit fit = FitOrientation(pairs, loss, start);
    const auto first = start.ToParameters();
    std::vector<double> x(first.begin(), first.end());
    const PraxisResult praxis = MinimizeWithPraxis(
        [&](const std::vector<double>& p) {
          const Sim3d transform = Sim3d::FromParameters({p[0], p[1], p[2], p[3], p[4], p[5], p[6]});
          double sum = 0;
          for (const PointPair& pair : pairs)
            sum += loss((transform * pair.point_in_head - pair.point_in_rig).squaredNorm()).cost;
          return sum;
        },
        {5, 5, 5, 0.2, 0.2, 0.2, 0.1}, 20000, &x);
    EXPECT_LE(fit.objective, Allowed(praxis.objective)) << "frame " << frame;
    worst = std::max(worst, fit.objective / praxis.objective - 1);
  }
  RecordProperty("worst_excess_over_praxis", std::to_string(worst));
}

}  // namespace
}  // namespace articap
