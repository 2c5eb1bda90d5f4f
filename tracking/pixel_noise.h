// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <vector>

namespace articap {

// What the values of pixels scatter by: of photons, of reading out, of rounding. Values are parts
// of the full range, 0 to 1.
struct PixelNoise {
  double read_variance = 1e-6;  // at value 0
  double gain = 0;  // variance that the value adds, per value; below 0 where values are negatives

  double VarianceAt(double value) const {
    return read_variance + gain * std::clamp(value, 0.0, 1.0);
  }
  // Of the picture with all values v replaced by 1 - v.
  PixelNoise Negative() const { return {read_variance + gain, -gain}; }
};

// Samples all over a picture, from which its noise is told: rows of pixels, each short enough to be
// either plain surface or not. In each range of brightness the rows count that bend no more than
// the plainest ones do, up to what chance makes of it: edges and texture are left out as long as a
// quarter of the rows are plain. Through the ranges goes the line read_variance + gain * value; a
// single one is taken to have the noise of photons.
class NoiseSamples {
 public:
  static constexpr int kLength = 32;  // of a row, px

  void Clear();
  // The light of `count` pixels side by side, at least three.
  void Add(const float* values, int count);
  // Nothing is below least_variance, that of rounding.
  PixelNoise Estimate(double least_variance);

 private:
  static constexpr int kRanges = 16;
  // Of a range of brightness.
  struct Range {
    std::vector<float> variances;  // of a pixel, by each row
    double values = 0;             // sum of the rows' means
  };
  std::array<Range, kRanges> ranges_;
};

}  // namespace articap
