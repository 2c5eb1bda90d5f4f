// SPDX-License-Identifier: MIT
// Gap filling of a minute of speech: 35 markers, 60 Hz, 0.1 mm noise; single samples missing at
// random, bursts missing, or both.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "synthetic/noise.h"
#include "tests/support/spoken_take.h"
#include "tracking/fill_gaps.h"

namespace articap {
namespace {

const SyntheticTake& Take() {
  static const SyntheticTake take = MakeSpokenTake({.num_sentences = 14}).take;
  return take;
}

// Of a coordinate.
double RmsOfFilled(const StageTracks& tracks) {
  const StageTracks& truth = Take().markers.tracks;
  double sum_mm2 = 0;
  int count = 0;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      if (tracks.state(frame, marker) != SampleState::kFilled) continue;
      sum_mm2 +=
          (tracks.position_mm(frame, marker) - truth.position_mm(frame, marker)).squaredNorm();
      ++count;
    }
  return std::sqrt(sum_mm2 / (3 * std::max(1, count)));
}

// Arguments: percent of the samples that drop out singly, and in bursts of 0.2 s on the average.
void BM_FillGaps(benchmark::State& state) {
  const SyntheticNoiseOptions noise{.noise_mm = 0.1,
                                    .dropout = static_cast<double>(state.range(0)) / 100,
                                    .gap = static_cast<double>(state.range(1)) / 100};
  const StageTracks tracks = AddNoise(Take().markers, noise, 1).markers.tracks;
  StageResult<StageTracks> filled;
  for (auto _ : state) filled = FillGaps(tracks).value();
  state.counters["markers"] = tracks.num_markers();
  state.counters["seconds"] = tracks.num_frames() / tracks.rate_hz();
  state.counters["gaps"] = filled.report.figures.front().second;
  state.counters["rms_mm"] = RmsOfFilled(filled.output);
}
BENCHMARK(BM_FillGaps)
    ->Args({0, 5})
    ->Args({2, 5})
    ->Args({10, 0})
    ->Args({30, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace articap
