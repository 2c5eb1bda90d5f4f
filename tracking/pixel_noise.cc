// SPDX-License-Identifier: MIT
#include "tracking/pixel_noise.h"

#include <cmath>
#include <numeric>

namespace articap {
namespace {

// Of normally distributed values with SD 1, the mean of the smallest 60 % of their amounts.
constexpr double kPart = 0.6;
constexpr double kMeanOfPart = 0.3966;

// The values of one range of brightness.
struct Level {
  double weight = 0;
  double value = 0;
  double variance = 0;
};

Level LevelOf(std::vector<float>& bends, double values) {
  const auto limit =
      bends.begin() + static_cast<std::ptrdiff_t>(kPart * static_cast<double>(bends.size()));
  std::nth_element(bends.begin(), limit, bends.end());
  const double mean =
      std::accumulate(bends.begin(), limit, 0.0) / static_cast<double>(limit - bends.begin());
  const double bend_sigma = mean / kMeanOfPart;
  const auto count = static_cast<double>(bends.size());
  return {count, values / count, bend_sigma * bend_sigma / 6};
}

// The weighted line, neither end below what rounding does.
PixelNoise LineThrough(const std::vector<Level>& levels, double least_variance) {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0, above = 0;
  for (const Level& level : levels) {
    // A variance is known to a part of itself.
    const double variance = std::max(level.variance, least_variance);
    const double weight = level.weight / (variance * variance);
    w += weight;
    x += weight * level.value;
    y += weight * variance;
    xx += weight * level.value * level.value;
    xy += weight * level.value * variance;
    above += weight * level.value * (variance - least_variance);
  }
  if (w == 0) return {least_variance, 0};
  const double scatter = xx - x * x / w;
  constexpr double kLeastSpread = 0.02;  // SD of the levels that tells a slope
  if (scatter < kLeastSpread * kLeastSpread * w) return {y / w, 0};
  const double gain = (xy - x * y / w) / scatter;
  const double read = (y - gain * x) / w;
  if (gain <= 0) return {y / w, 0};
  if (read < least_variance) return {least_variance, above / xx};
  return {read, gain};
}

}  // namespace

void NoiseSamples::Clear() {
  for (Range& range : ranges_) {
    range.bends.clear();
    range.values = 0;
  }
}

void NoiseSamples::Add(float left, float middle, float right) {
  Range& range = ranges_[std::clamp(static_cast<int>(middle * kRanges), 0, kRanges - 1)];
  range.bends.push_back(std::abs(2 * middle - left - right));
  range.values += middle;
}

PixelNoise NoiseSamples::Estimate(double least_variance) {
  constexpr std::size_t kEnough = 60;
  std::vector<Level> levels;
  for (Range& range : ranges_)
    if (range.bends.size() >= kEnough) levels.push_back(LevelOf(range.bends, range.values));
  return LineThrough(levels, least_variance);
}

}  // namespace articap
