// SPDX-License-Identifier: MIT
#include "tracking/pixel_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace articap {
namespace {

std::uint16_t Code16(const ImageView& image, int x, int y) {
  std::uint16_t code = 0;
  std::memcpy(&code, image.row(y) + 2 * static_cast<std::ptrdiff_t>(x), sizeof(code));
  return code;
}

const std::uint8_t* Rgb(const ImageView& image, int x, int y) {
  return image.row(y) + 3 * static_cast<std::ptrdiff_t>(x);
}

// A coarse grid all over the picture.
Eigen::Vector3f MeanColor(const ImageView& image) {
  const int step_x = std::max(1, image.width / 64), step_y = std::max(1, image.height / 36);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  for (int y = step_y / 2; y < image.height; y += step_y)
    for (int x = step_x / 2; x < image.width; x += step_x, ++count)
      sum += Eigen::Map<const Eigen::Matrix<std::uint8_t, 3, 1>>(Rgb(image, x, y)).cast<float>();
  return sum / (255.0f * static_cast<float>(std::max(1, count)));
}

}  // namespace

float PixelReader::Linear(double code) const {
  if (!values_.srgb_tone) return static_cast<float>(code);
  return static_cast<float>(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
}

void PixelReader::Open(const ImageView& image) {
  image_ = image;
  if (image.format == PixelFormat::kRgb8 && !image.empty()) SetColorWeights();
  if (!has_tables_ || tables_for_ != image.format || image.format == PixelFormat::kRgb8)
    SetTables();
  has_tables_ = true;
  tables_for_ = image.format;
}

void PixelReader::SetColorWeights() {
  // People's: ITU-R BT.709. Video resolves its brightness better than its colours, too.
  weights_ = {0.2126f, 0.7152f, 0.0722f};
  if (values_.color) {
    const Eigen::Vector3f apart = *values_.color - MeanColor(image_);
    const float size = apart.cwiseAbs().sum();
    if (size > 0) weights_ = apart / size;
  } else if (values_.dark_dots) {
    weights_ *= -1;
  }
  offset_ = -weights_.cwiseMin(0.0f).sum();
}

void PixelReader::SetTables() {
  if (image_.format == PixelFormat::kRgb8) {
    for (int channel = 0; channel < 3; ++channel)
      for (int code = 0; code < 256; ++code) {
        const float part = channel == 0 ? offset_ : 0;
        color_[channel][code] = part + weights_[channel] * Linear(code / 255.0);
        row_color_[channel][code] = static_cast<std::int32_t>(
            std::lround(65536.0f * (255 * part + weights_[channel] * static_cast<float>(code))));
      }
    return;
  }
  const int codes = is_16_bit() ? 65536 : 256;
  gray_.resize(codes);
  for (int code = 0; code < codes; ++code) {
    const float linear = Linear(static_cast<double>(code) / (codes - 1));
    gray_[code] = values_.dark_dots ? 1 - linear : linear;
  }
}

float PixelReader::ValueOfOthers(int x, int y) const {
  if (is_16_bit()) return gray_[Code16(image_, x, y)];
  const std::uint8_t* rgb = Rgb(image_, x, y);
  return color_[0][rgb[0]] + color_[1][rgb[1]] + color_[2][rgb[2]];
}

void PixelReader::ReadValues(int x, int y, int count, float* values) const {
  if (image_.format == PixelFormat::kGray8) {
    const std::uint8_t* codes = image_.row(y) + x;
    for (int i = 0; i < count; ++i) values[i] = gray_[codes[i]];
    return;
  }
  for (int i = 0; i < count; ++i) values[i] = Value(x + i, y);
}

bool PixelReader::IsColorSaturated(int x, int y) const {
  const std::uint8_t* rgb = Rgb(image_, x, y);
  for (int channel = 0; channel < 3; ++channel)
    if (rgb[channel] == (weights_[channel] > 0 ? 255 : 0) && std::abs(weights_[channel]) > 0.2f)
      return true;
  return false;
}

double PixelReader::least_variance() const {
  const double step = is_16_bit() ? 1.0 / 65535 : 1.0 / 255;
  const double scale = image_.format == PixelFormat::kRgb8 ? weights_.norm() : 1;
  return step * step * scale * scale / 12;
}

template <class Integer>
void PixelReader::ReadRow(int y, Integer* row) const {
  const int count = image_.width;
  if (image_.format == PixelFormat::kRgb8) {
    const std::uint8_t* rgb = image_.row(y);
    for (int x = 0; x < count; ++x, rgb += 3)
      row[x] = static_cast<Integer>(std::clamp(
          (row_color_[0][rgb[0]] + row_color_[1][rgb[1]] + row_color_[2][rgb[2]] + 32768) >> 16, 0,
          255));
    return;
  }
  std::memcpy(row, image_.row(y), static_cast<std::size_t>(count) * sizeof(Integer));
  if (!values_.dark_dots) return;
  for (int x = 0; x < count; ++x) row[x] = static_cast<Integer>(~row[x]);
}

template void PixelReader::ReadRow(int y, std::uint8_t* row) const;
template void PixelReader::ReadRow(int y, std::uint16_t* row) const;

void PixelReader::SampleNoise(NoiseSamples& samples) const {
  samples.Clear();
  constexpr int kRows = 24, kColumns = 24, kLength = NoiseSamples::kLength;
  const int length = std::min(kLength, image_.width);
  if (length < 3) return;
  const int step_y = std::max(1, image_.height / kRows);
  const int step_x = std::max(length, image_.width / kColumns);
  std::array<float, kLength> values;
  for (int y = step_y / 2; y < image_.height; y += step_y)
    for (int x = 0; x + length <= image_.width; x += step_x) {
      ReadValues(x, y, length, values.data());
      // At the ends of the range values do not scatter.
      const auto at_ends = std::count_if(values.begin(), values.begin() + length, [](float value) {
        return value <= 1 - kSaturation || value >= kSaturation;
      });
      if (10 * at_ends > length) continue;
      if (values_.dark_dots)
        for (float& value : values) value = 1 - value;
      samples.Add(values.data(), length);
    }
}

}  // namespace articap
