// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/image.h"
#include "tracking/pixel_noise.h"

namespace articap {

// How pixels become values: what makes every kind of picture one in which dots are bright.
struct PixelValues {
  bool dark_dots = false;
  bool srgb_tone = false;
  // Of the dots in pictures in colour, RGB as the file has it, 0 to 1: values are then the colours'
  // components along the way to this one from the picture's mean.
  std::optional<Eigen::Vector3f> color;
};

// Values of pixels, parts of the full range of linear light, 0 to 1, dots brighter than what
// surrounds them.
class PixelReader {
 public:
  explicit PixelReader(const PixelValues& values) : values_(values) {}

  // From now on this picture.
  void Open(const ImageView& image);

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  float Value(int x, int y) const {
    return image_.format == PixelFormat::kGray8 ? gray_[image_.row(y)[x]] : ValueOfOthers(x, y);
  }
  // Of pixels side by side.
  void ReadValues(int x, int y, int count, float* values) const;
  // Whether the light may be more than the value, which is the pixel's.
  bool IsSaturated(int x, int y, float value) const {
    return image_.format == PixelFormat::kRgb8 ? IsColorSaturated(x, y) : value >= kSaturation;
  }
  // Rounding alone, on average.
  double least_variance() const;

  // A row for comparisons alone, whole numbers of the file's own range: without the tone, 8 bits
  // for kGray8 and kRgb8, 16 for kGray16.
  template <class Integer>
  void ReadRow(int y, Integer* row) const;
  bool is_16_bit() const { return image_.format == PixelFormat::kGray16; }

  // The light of some hundred rows of pixels, evenly spread: dark dots are dark here.
  void SampleNoise(NoiseSamples& samples) const;

 private:
  // A little less than the last code of 8 bits, and what cameras of 10 or 12 bits end at in 16.
  static constexpr float kSaturation = 0.998f;

  float ValueOfOthers(int x, int y) const;  // than kGray8
  bool IsColorSaturated(int x, int y) const;
  void SetColorWeights();
  void SetTables();
  float Linear(double code) const;

  PixelValues values_;
  ImageView image_;
  PixelFormat tables_for_ = PixelFormat::kRgb8;
  bool has_tables_ = false;
  Eigen::Vector3f weights_ = Eigen::Vector3f::Zero();  // of the colours
  float offset_ = 0;
  std::vector<float> gray_;                                 // value of every code
  std::array<std::array<float, 256>, 3> color_;             // the part of each colour
  std::array<std::array<std::int32_t, 256>, 3> row_color_;  // 16.16 fixed point, of 0 to 255
};

}  // namespace articap
