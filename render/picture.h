// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/result.h"

namespace articap {

// An 8-bit sRGB picture, rows from top to bottom, three bytes a pixel. The centre of the top left
// pixel is at (0, 0).
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb8;

  std::uint8_t* pixel(int x, int y) { return &rgb8[3 * (static_cast<std::size_t>(y) * width + x)]; }
  const std::uint8_t* pixel(int x, int y) const {
    return &rgb8[3 * (static_cast<std::size_t>(y) * width + x)];
  }
};

// The same in linear light, before exposure to 8 bits: what a simulated sensor starts from.
struct LinearPicture {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector3f> rgb;
};

// A picture of one colour.
Picture FilledPicture(int width, int height, const Eigen::Vector3f& linear_color);

// Linear light 0..1 to an sRGB byte (IEC 61966-2-1); values outside are clipped.
std::uint8_t SrgbByte(float linear);
Picture EncodeSrgb(const LinearPicture& linear);

// The bytes of a PNG file.
Result<std::string> EncodePng(const Picture& picture);
Result<void> WritePng(const Picture& picture, const std::filesystem::path& path);
// The same of what cameras deliver: grey with 8 or 16 bits, or RGB; the values as they are.
Result<std::string> EncodePng(const ImageView& image);
Result<void> WritePng(const ImageView& image, const std::filesystem::path& path);

// Any PNG as 8-bit RGB; an alpha channel is laid over black.
Result<Picture> DecodePng(std::string_view bytes);
Result<Picture> ReadPng(const std::filesystem::path& path);

}  // namespace articap
