// SPDX-License-Identifier: MIT
// Head stabilisation in frames per second, on a take of 35 markers: five references on spectacles
// (or thirty-five markers in all), 0.2 mm noise, and as many outliers as asked for.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "core/alignment.h"
#include "core/landmarks.h"
#include "tracking/stabilize.h"

namespace articap {
namespace {

MarkerSet AllLandmarksAsMarkers() {
  MarkerSet set;
  for (const LandmarkInfo& info : AllLandmarks()) {
    if (set.markers.size() == 30 && !info.name.starts_with("spectacles")) continue;
    MarkerRole role;
    role.name = role.landmark = info.name;
    role.head_reference = info.name.starts_with("spectacles");
    set.markers.push_back(role);
  }
  return set;
}

StageTracks MakeTake(const MarkerSet& set, int num_frames, double outliers) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<std::string> names;
  for (const MarkerRole& marker : set.markers) names.push_back(marker.name);
  StageTracks tracks(names, num_frames, 60);
  for (int frame = 0; frame < num_frames; ++frame) {
    const Eigen::Quaterniond rotation(
        Eigen::AngleAxisd(0.2 * std::sin(0.03 * frame), Eigen::Vector3d(1, 2, 3).normalized()));
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      Eigen::Vector3d point_mm =
          rotation * FindLandmark(names[static_cast<std::size_t>(marker)])->typical_mm;
      point_mm += 0.2 * Eigen::Vector3d{normal(random), normal(random), normal(random)};
      if (uniform(random) < outliers) point_mm.x() += 10;
      tracks.Set(frame, marker, point_mm);
    }
  }
  return tracks;
}

// Arguments: frames; outliers in a thousand samples; whether to look for a better set.
void BM_Stabilize(benchmark::State& state) {
  const MarkerSet set = AllLandmarksAsMarkers();
  const StageTracks tracks =
      MakeTake(set, static_cast<int>(state.range(0)), static_cast<double>(state.range(1)) / 1000);
  StabilizeOptions options;
  options.propose = state.range(2) != 0;
  for (auto _ : state) {
    const auto result = Stabilize(tracks, set, std::nullopt, options);
    if (!result) state.SkipWithError(result.error().message.c_str());
    benchmark::DoNotOptimize(result);
  }
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(state.range(0)),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(BM_Stabilize)
    ->ArgNames({"frames", "outliers_permille", "propose"})
    ->Args({70000, 0, 0})
    ->Args({70000, 0, 1})
    ->Args({70000, 20, 1})
    ->Args({7000, 0, 1})
    ->Args({700, 0, 1})
    ->Unit(benchmark::kMillisecond);

// One alignment of five points.
void BM_AlignRigid(benchmark::State& state) {
  std::vector<Eigen::Vector3d> source, target;
  for (int i = 1; i <= 5; ++i) {
    source.push_back(FindLandmark("spectacles_" + std::to_string(i))->typical_mm);
    target.push_back(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()) * source.back());
  }
  for (auto _ : state) benchmark::DoNotOptimize(AlignRigid(source, target));
}
BENCHMARK(BM_AlignRigid);

}  // namespace
}  // namespace articap
