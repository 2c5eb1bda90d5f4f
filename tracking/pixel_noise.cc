// SPDX-License-Identifier: MIT
#include "tracking/pixel_noise.h"

#include <cmath>

namespace articap {
namespace {

// The values of one range of brightness.
struct Level {
  double weight = 0;
  double value = 0;
  double variance = 0;
};

// The mean of the variances that chance makes of one: those up to kMost of it, from the plainest
// rows on.
double PlainVariance(std::vector<float>& variances) {
  constexpr double kPlainest = 0.25;
  const auto plainest = variances.begin() + static_cast<std::ptrdiff_t>(
                                                kPlainest * static_cast<double>(variances.size()));
  std::nth_element(variances.begin(), plainest, variances.end());
  double variance = *plainest;
  // The mean square of thirty bends, of which neighbours share pixels, has an SD of 0.36 of it.
  // Without the 3 % of rows beyond kMost the mean is a little low.
  constexpr double kMost = 1.75, kMeanBelowMost = 0.966;
  constexpr int kMostPasses = 10;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const auto limit = static_cast<float>(kMost * variance);
    double sum = 0;
    int count = 0;
    for (const float one : variances)
      if (one <= limit) {
        sum += one;
        ++count;
      }
    const double next = sum / count / kMeanBelowMost;
    if (next <= 1.001 * variance) return next;
    variance = next;
  }
  return variance;
}

// Where one level of brightness alone is seen: light's own noise, as far as a pixel of the fewest
// electrons has it, and the rest that of reading.
PixelNoise OfOneLevel(double value, double variance, double least_variance) {
  constexpr double kFewestElectrons = 1000;
  const double of_light = std::max(0.0, variance - least_variance);
  const double gain = std::min(of_light / std::max(value, 1e-6), 1 / kFewestElectrons);
  return {variance - gain * value, gain};
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
  if (scatter < kLeastSpread * kLeastSpread * w) return OfOneLevel(x / w, y / w, least_variance);
  const double gain = (xy - x * y / w) / scatter;
  const double read = (y - gain * x) / w;
  if (gain <= 0) return {y / w, 0};
  if (read < least_variance) return {least_variance, above / xx};
  return {read, gain};
}

}  // namespace

void NoiseSamples::Clear() {
  for (Range& range : ranges_) {
    range.variances.clear();
    range.values = 0;
  }
}

void NoiseSamples::Add(const float* values, int count) {
  float sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) sum += values[i];
  for (int i = 1; i + 1 < count; ++i) {
    const float bend = 2 * values[i] - values[i - 1] - values[i + 1];
    squares += bend * bend;
  }
  const float mean = sum / static_cast<float>(count);
  Range& range = ranges_[std::clamp(static_cast<int>(mean * kRanges), 0, kRanges - 1)];
  // A bend is twice the pixel less both of its neighbours: its variance is six times a pixel's.
  range.variances.push_back(squares / static_cast<float>(6 * (count - 2)));
  range.values += mean;
}

PixelNoise NoiseSamples::Estimate(double least_variance) {
  constexpr std::size_t kEnough = 5;
  std::vector<Level> levels;
  for (Range& range : ranges_) {
    const auto count = static_cast<double>(range.variances.size());
    if (range.variances.size() >= kEnough)
      levels.push_back({count, range.values / count, PlainVariance(range.variances)});
  }
  return LineThrough(levels, least_variance);
}

}  // namespace articap
