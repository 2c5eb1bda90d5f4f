// SPDX-License-Identifier: MIT
// The shape fit on thirty markers of the speaking default head, 0.2 mm noise, one thread: the
// evaluator alone, frames fitted from warm starts, and PRAXIS on the same frames from the same
// starts.
#include <benchmark/benchmark.h>

#include <limits>

#include "fitting/ceres_shape_solver.h"
#include "fitting/shape_solver.h"
#include "tests/support/praxis.h"
#include "tests/support/speech_scene.h"

namespace articap {
namespace {

const SpeechScene& Scene() {
  static const SpeechScene scene = MakeSpeechScene(8, 0.2);
  return scene;
}

const VirtualMarkerEvaluator& Evaluator() {
  static const VirtualMarkerEvaluator evaluator(Scene().rig, Scene().markers);
  return evaluator;
}

void CountFrames(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations());
  state.counters["markers"] = static_cast<double>(Scene().markers.size());
}

void BM_PositionsAndJacobian(benchmark::State& state) {
  const SpeechScene& scene = Scene();
  std::vector<double> jacobian(3 * static_cast<std::size_t>(Evaluator().num_parameters()));
  Eigen::Index frame = 0;
  for (auto _ : state) {
    const Eigen::VectorXd y = scene.truth.row(frame);
    frame = (frame + 1) % scene.truth.rows();
    const auto pose = Evaluator().PoseOf({y.data(), static_cast<std::size_t>(y.size())});
    for (int i = 0; i < Evaluator().num_markers(); ++i)
      benchmark::DoNotOptimize(Evaluator().PositionAndJacobian(pose, i, jacobian.data()));
  }
  CountFrames(state);
}
BENCHMARK(BM_PositionsAndJacobian);

void BM_FitFrames(benchmark::State& state) {
  const SpeechScene& scene = Scene();
  ShapeSolver solver(Evaluator(), scene.lower, scene.upper);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(Evaluator().num_parameters());
  std::size_t frame = 0;
  std::int64_t evaluations = 0;
  for (auto _ : state) {
    evaluations += solver.Solve(scene.measured[frame], &y).evaluations;
    frame = (frame + 1) % scene.measured.size();
  }
  CountFrames(state);
  state.counters["evaluations_per_frame"] =
      static_cast<double>(evaluations) / static_cast<double>(state.iterations());
}
BENCHMARK(BM_FitFrames);

void BM_FitFramesWithCeres(benchmark::State& state) {
  const SpeechScene& scene = Scene();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(Evaluator().num_parameters());
  std::size_t frame = 0;
  for (auto _ : state) {
    SolveShapeWithCeres(Evaluator(), scene.lower, scene.upper, {}, scene.measured[frame], &y);
    frame = (frame + 1) % scene.measured.size();
  }
  CountFrames(state);
}
BENCHMARK(BM_FitFramesWithCeres);

void BM_FitFramesWithPraxis(benchmark::State& state) {
  const SpeechScene& scene = Scene();
  LinearizedFrame linearized(Evaluator(), {});
  const int num_parameters = Evaluator().num_parameters();
  std::vector<double> steps, y(num_parameters, 0.0);
  for (int k = 0; k < num_parameters; ++k)
    steps.push_back(0.05 * (scene.upper[k] - scene.lower[k]));
  std::size_t frame = 0;
  std::int64_t evaluations = 0;
  for (auto _ : state) {
    evaluations += MinimizeWithPraxis(
                       [&](const std::vector<double>& x) {
                         return linearized.Objective(
                             scene.measured[frame],
                             Eigen::Map<const Eigen::VectorXd>(x.data(), num_parameters));
                       },
                       steps, 20000, &y)
                       .evaluations;
    frame = (frame + 1) % scene.measured.size();
  }
  CountFrames(state);
  state.counters["evaluations_per_frame"] =
      static_cast<double>(evaluations) / static_cast<double>(state.iterations());
}
BENCHMARK(BM_FitFramesWithPraxis);

}  // namespace
}  // namespace articap
