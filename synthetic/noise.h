// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/marker_recording.h"
#include "core/options.h"
#include "core/result.h"

namespace articap {

struct SyntheticNoiseOptions {
  double noise_mm = 0;        // SD of the Gaussian noise of each coordinate
  double dropout = 0;         // probability of a sample to be missing, each on its own
  double gap = 0;             // fraction of a marker's samples that are missing in bursts
  double gap_length_s = 0.2;  // mean length of these bursts
  double outliers = 0;        // probability of a seen sample to be an outlier
  double outlier_mm = 10;     // how far outliers are off, in any direction
  double swaps_hz = 0;  // how often a second two neighbouring markers are taken for one another
  double swap_length_s = 0.1;
};
void VisitOptions(SyntheticNoiseOptions& options, OptionVisitor& visit);
// Names the option that makes no sense: a probability above 1, a negative length.
Result<void> CheckOptions(const SyntheticNoiseOptions& options);

// What was done to a sample. Later kinds win: a swapped outlier counts as swapped.
enum class SampleFault : std::uint8_t { kNone, kDropout, kGap, kOutlier, kSwap };

struct DisturbedRecording {
  MarkerRecording markers;
  std::vector<SampleFault> faults;  // frames x markers

  SampleFault fault(int frame, int marker) const {
    return faults[static_cast<std::size_t>(frame) * markers.tracks.num_markers() + marker];
  }
  int Count(SampleFault kind) const;
};

// Disturbs a recording as cameras and their software do. The kinds draw from separate streams, so
// that the noise stays the same when outliers are switched on.
DisturbedRecording AddNoise(const MarkerRecording& recording, const SyntheticNoiseOptions& options,
                            std::uint64_t seed);

}  // namespace articap
