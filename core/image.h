// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace articap {

enum class PixelFormat : std::uint8_t {
  kGray8,
  kGray16,  // in the byte order of the machine, the full range used: 0 black, 65535 white
  kRgb8,    // three bytes a pixel, red first
};

constexpr int BytesPerPixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGray8:
      return 1;
    case PixelFormat::kGray16:
      return 2;
    case PixelFormat::kRgb8:
      return 3;
  }
  return 0;
}

// Pixels that somebody else owns, rows from top to bottom. The centre of the top left pixel is at
// (0, 0), x to the right, y down: everywhere in articap.
struct ImageView {
  PixelFormat format = PixelFormat::kGray8;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride_bytes = 0;  // from one row to the next
  const std::uint8_t* data = nullptr;

  bool empty() const { return width == 0 || height == 0; }
  const std::uint8_t* row(int y) const { return data + y * stride_bytes; }
};

// Pixels with their owner, rows without gaps.
struct Image {
  PixelFormat format = PixelFormat::kGray8;
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bytes;

  Image() = default;
  Image(PixelFormat pixel_format, int image_width, int image_height)
      : format(pixel_format),
        width(image_width),
        height(image_height),
        bytes(static_cast<std::size_t>(image_width) * image_height * BytesPerPixel(pixel_format)) {}

  ImageView view() const {
    return {format, width, height, static_cast<std::ptrdiff_t>(width) * BytesPerPixel(format),
            bytes.data()};
  }
  std::uint8_t* row(int y) {
    return bytes.data() + static_cast<std::size_t>(y) * width * BytesPerPixel(format);
  }
};

}  // namespace articap
