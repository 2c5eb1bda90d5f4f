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

// Samples all over a picture, from which its noise is told. In each range of brightness the
// smallest 60 % of the bends count, since edges and texture are rarer than plain surface; through
// the ranges goes the line read_variance + gain * value.
class NoiseSamples {
 public:
  void Clear();
  // A pixel and its two neighbours in the row.
  void Add(float left, float middle, float right);
  // Nothing is below least_variance, that of rounding.
  PixelNoise Estimate(double least_variance);

 private:
  static constexpr int kRanges = 16;
  // Of a range of brightness. A bend is twice the pixel less both of its neighbours: its variance
  // is six times that of a pixel.
  struct Range {
    std::vector<float> bends;
    double values = 0;  // sum
  };
  std::array<Range, kRanges> ranges_;
};

}  // namespace articap
