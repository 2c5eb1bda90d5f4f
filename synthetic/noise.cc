// SPDX-License-Identifier: MIT
#include "synthetic/noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"
#include "synthetic/random.h"
#include "synthetic/random_streams.h"

namespace articap {
namespace {

// Writes into a recording and remembers the faults.
class Disturber {
 public:
  Disturber(const MarkerRecording& recording, const SyntheticNoiseOptions& options,
            std::uint64_t seed)
      : options_(options), seed_(seed), tracks_(recording.tracks) {
    out_.markers = recording;
    const std::size_t num_samples =
        static_cast<std::size_t>(tracks_.num_frames()) * tracks_.num_markers();
    out_.faults.assign(num_samples, SampleFault::kNone);
  }

  DisturbedRecording Disturb() {
    AddGaussian();
    AddDropouts();
    AddGaps();
    AddOutliers();
    AddSwaps();
    out_.markers.tracks = std::move(tracks_);
    return std::move(out_);
  }

 private:
  void AddGaussian() {
    if (options_.noise_mm <= 0) return;
    RandomGenerator random(seed_, random_streams::kNoise);
    ForAllSamples([&](int frame, int marker) {
      Move(frame, marker, options_.noise_mm * random.NormalVector());
    });
  }

  void AddDropouts() {
    if (options_.dropout <= 0) return;
    RandomGenerator random(seed_, random_streams::kDropouts);
    ForAllSamples([&](int frame, int marker) {
      if (random.Happens(options_.dropout)) Lose(frame, marker, SampleFault::kDropout);
    });
  }

  // Seen and lost alternate, each for a random time with the mean that gives the wanted fraction.
  void AddGaps() {
    if (options_.gap <= 0) return;
    ARTICAP_CHECK_LT(options_.gap, 1);
    RandomGenerator random(seed_, random_streams::kGaps);
    const double mean_gap = std::max(1.0, options_.gap_length_s * tracks_.rate_hz());
    const double mean_seen = mean_gap * (1 / options_.gap - 1);
    for (int marker = 0; marker < tracks_.num_markers(); ++marker) {
      bool seen = !random.Happens(options_.gap);
      for (int frame = 0; frame < tracks_.num_frames(); ++frame) {
        if (!seen && !tracks_.is_missing(frame, marker)) Lose(frame, marker, SampleFault::kGap);
        if (random.Happens(1 / (seen ? mean_seen : mean_gap))) seen = !seen;
      }
    }
  }

  void AddOutliers() {
    if (options_.outliers <= 0) return;
    RandomGenerator random(seed_, random_streams::kOutliers);
    ForAllSamples([&](int frame, int marker) {
      const bool happens = random.Happens(options_.outliers);
      const Eigen::Vector3d direction = random.Direction();
      if (!happens || tracks_.is_missing(frame, marker)) return;
      Move(frame, marker, options_.outlier_mm * direction);
      FaultAt(frame, marker) = SampleFault::kOutlier;
    });
  }

  void AddSwaps() {
    if (options_.swaps_hz <= 0 || tracks_.num_markers() < 2) return;
    RandomGenerator random(seed_, random_streams::kSwaps);
    const int length =
        std::max(1, static_cast<int>(std::lround(options_.swap_length_s * tracks_.rate_hz())));
    for (int begin = 0; begin < tracks_.num_frames(); ++begin) {
      if (!random.Happens(options_.swaps_hz / tracks_.rate_hz())) continue;
      const int marker = random.Index(tracks_.num_markers());
      const int other = NearestOther(begin, marker);
      if (other < 0) continue;
      const int end = std::min(begin + length, tracks_.num_frames());
      for (int frame = begin; frame < end; ++frame) Swap(frame, marker, other);
      begin = end;
    }
  }

  // The nearest marker seen in that frame; -1 if there is none or `marker` is not seen.
  int NearestOther(int frame, int marker) const {
    int nearest = -1;
    double least_mm = std::numeric_limits<double>::infinity();
    for (int other = 0; other < tracks_.num_markers(); ++other) {
      if (other == marker) continue;
      const double distance_mm =
          (tracks_.position_mm(frame, other) - tracks_.position_mm(frame, marker)).norm();
      if (!(distance_mm < least_mm)) continue;  // missing samples are NaN
      least_mm = distance_mm;
      nearest = other;
    }
    return nearest;
  }

  void Swap(int frame, int a, int b) {
    if (tracks_.is_missing(frame, a) || tracks_.is_missing(frame, b)) return;
    const Eigen::Vector3d position_mm = tracks_.position_mm(frame, a);
    tracks_.Set(frame, a, tracks_.position_mm(frame, b));
    tracks_.Set(frame, b, position_mm);
    FaultAt(frame, a) = FaultAt(frame, b) = SampleFault::kSwap;
  }

  // Every sample draws its random numbers, missing or not, so that the streams stay in step.
  template <class Action>
  void ForAllSamples(Action action) {
    for (int frame = 0; frame < tracks_.num_frames(); ++frame)
      for (int marker = 0; marker < tracks_.num_markers(); ++marker) action(frame, marker);
  }

  void Move(int frame, int marker, const Eigen::Vector3d& displacement_mm) {
    if (tracks_.is_missing(frame, marker)) return;
    tracks_.Set(frame, marker, tracks_.position_mm(frame, marker) + displacement_mm,
                tracks_.state(frame, marker), tracks_.sigma_mm(frame, marker));
  }

  void Lose(int frame, int marker, SampleFault kind) {
    tracks_.SetMissing(frame, marker);
    FaultAt(frame, marker) = kind;
  }

  SampleFault& FaultAt(int frame, int marker) {
    return out_.faults[static_cast<std::size_t>(frame) * tracks_.num_markers() + marker];
  }

  const SyntheticNoiseOptions& options_;
  std::uint64_t seed_;
  StageTracks tracks_;
  DisturbedRecording out_;
};

}  // namespace

void VisitOptions(SyntheticNoiseOptions& options, OptionVisitor& visit) {
  visit("noise_mm", options.noise_mm, "SD of the noise of each coordinate; mm");
  visit("dropout", options.dropout, "probability of a sample to be missing");
  visit("gap", options.gap, "fraction of the samples that are missing in bursts");
  visit("gap_length_s", options.gap_length_s, "mean length of these bursts; s");
  visit("outliers", options.outliers, "probability of a seen sample to be an outlier");
  visit("outlier_mm", options.outlier_mm, "how far outliers are off; mm");
  visit("swaps_hz", options.swaps_hz, "how often a second two neighbouring markers are swapped");
  visit("swap_length_s", options.swap_length_s, "for how long they stay swapped; s");
}

Result<void> CheckOptions(const SyntheticNoiseOptions& options) {
  const std::pair<const char*, double> parts[] = {
      {"dropout", options.dropout}, {"gap", options.gap}, {"outliers", options.outliers}};
  for (const auto& [name, value] : parts)
    if (!(value >= 0 && value <= 1))
      return Fail(fmt::format("{} is {}; it must be between 0 and 1", name, value));
  if (options.gap == 1) return Fail("gap is 1; it must be below 1, or nothing would be seen");
  const std::pair<const char*, double> sizes[] = {{"noise_mm", options.noise_mm},
                                                  {"gap_length_s", options.gap_length_s},
                                                  {"outlier_mm", options.outlier_mm},
                                                  {"swaps_hz", options.swaps_hz},
                                                  {"swap_length_s", options.swap_length_s}};
  for (const auto& [name, value] : sizes)
    if (!(value >= 0 && std::isfinite(value)))
      return Fail(fmt::format("{} is {}; it must be 0 or more", name, value));
  return {};
}

int DisturbedRecording::Count(SampleFault kind) const {
  return static_cast<int>(std::count(faults.begin(), faults.end(), kind));
}

DisturbedRecording AddNoise(const MarkerRecording& recording, const SyntheticNoiseOptions& options,
                            std::uint64_t seed) {
  return Disturber(recording, options, seed).Disturb();
}

}  // namespace articap
