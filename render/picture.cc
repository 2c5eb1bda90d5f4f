// SPDX-License-Identifier: MIT
#include "render/picture.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/file_io.h"

namespace articap {
namespace {

png_uint_32 PngFormatOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGray8:
      return PNG_FORMAT_GRAY;
    case PixelFormat::kGray16:
      return PNG_FORMAT_LINEAR_Y;
    case PixelFormat::kRgb8:
      break;
  }
  return PNG_FORMAT_RGB;
}

}  // namespace

Picture FilledPicture(int width, int height, const Eigen::Vector3f& linear_color) {
  Picture picture{width, height,
                  std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height)};
  const std::uint8_t color[3] = {SrgbByte(linear_color[0]), SrgbByte(linear_color[1]),
                                 SrgbByte(linear_color[2])};
  for (std::size_t i = 0; i < picture.rgb8.size(); ++i) picture.rgb8[i] = color[i % 3];
  return picture;
}

std::uint8_t SrgbByte(float linear) {
  const float light = std::clamp(linear, 0.0f, 1.0f);
  const float encoded =
      light <= 0.0031308f ? 12.92f * light : 1.055f * std::pow(light, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

Picture EncodeSrgb(const LinearPicture& linear) {
  Picture picture{linear.width, linear.height, {}};
  picture.rgb8.reserve(3 * linear.rgb.size());
  for (const Eigen::Vector3f& color : linear.rgb)
    for (const float channel : {color[0], color[1], color[2]})
      picture.rgb8.push_back(SrgbByte(channel));
  return picture;
}

Result<std::string> EncodePng(const Picture& picture) {
  ARTICAP_CHECK_EQ(picture.rgb8.size(),
                   3 * static_cast<std::size_t>(picture.width) * picture.height);
  return EncodePng(ImageView{PixelFormat::kRgb8, picture.width, picture.height,
                             static_cast<std::ptrdiff_t>(picture.width) * 3, picture.rgb8.data()});
}

Result<void> WritePng(const Picture& picture, const std::filesystem::path& path) {
  const auto bytes = EncodePng(picture);
  if (!bytes) return tl::unexpected(bytes.error());
  return WriteFile(path, *bytes);
}

Result<std::string> EncodePng(const ImageView& image) {
  ARTICAP_CHECK(image.width > 0 && image.height > 0);
  const int bytes_per_component = image.format == PixelFormat::kGray16 ? 2 : 1;
  ARTICAP_CHECK_EQ(image.stride_bytes % bytes_per_component, 0);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PngFormatOf(image.format);
  const auto stride = static_cast<png_int_32>(image.stride_bytes / bytes_per_component);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.data, stride, nullptr) == 0)
    return Fail(fmt::format("a picture of {} x {} pixels cannot become a PNG: {}", image.width,
                            image.height, png.message));
  bytes.resize(size);
  return bytes;
}

Result<void> WritePng(const ImageView& image, const std::filesystem::path& path) {
  const auto bytes = EncodePng(image);
  if (!bytes) return tl::unexpected(bytes.error());
  return WriteFile(path, *bytes);
}

Result<Picture> DecodePng(std::string_view bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0)
    return Fail(fmt::format("not a PNG that can be read: {}", image.message));
  image.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb8.resize(PNG_IMAGE_SIZE(image));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&image, &black, picture.rgb8.data(), 0, nullptr) == 0)
    return Fail(fmt::format("the PNG is damaged: {}", image.message));
  return picture;
}

Result<Picture> ReadPng(const std::filesystem::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  auto picture = DecodePng(*bytes);
  if (!picture) return Fail(fmt::format("{}: {}", path.string(), picture.error().message));
  return picture;
}

}  // namespace articap
