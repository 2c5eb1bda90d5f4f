// SPDX-License-Identifier: MIT
#include "render/picture.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "core/check.h"

namespace articap {

Picture FilledPicture(int width, int height, const Eigen::Vector3f& linear_color) {
  Picture picture{width, height,
                  std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height)};
  for (std::size_t i = 0; i < picture.rgb8.size(); ++i)
    picture.rgb8[i] = SrgbByte(linear_color[static_cast<int>(i % 3)]);
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

Result<void> WritePng(const Picture& picture, const std::filesystem::path& path) {
  ARTICAP_CHECK_GT(picture.width, 0);
  ARTICAP_CHECK_GT(picture.height, 0);
  ARTICAP_CHECK_EQ(picture.rgb8.size(),
                   3 * static_cast<std::size_t>(picture.width) * picture.height);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  std::filesystem::path partial = path;
  partial += ".partial";
  std::error_code error;
  if (png_image_write_to_file(&image, partial.c_str(), 0, picture.rgb8.data(), 0, nullptr) == 0) {
    std::filesystem::remove(partial, error);
    return Fail(
        fmt::format("cannot write the picture {}: {}; check that the folder exists and is "
                    "writable",
                    path.string(), image.message));
  }
  std::filesystem::rename(partial, path, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(partial, error);
    return Fail(fmt::format("cannot write the picture {}: {}", path.string(), reason));
  }
  return {};
}

Result<Picture> ReadPng(const std::filesystem::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0)
    return Fail(fmt::format("cannot read the picture {}: {}", path.string(), image.message));
  image.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb8.resize(PNG_IMAGE_SIZE(image));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&image, &black, picture.rgb8.data(), 0, nullptr) == 0)
    return Fail(fmt::format("cannot read the picture {}: {}", path.string(), image.message));
  return picture;
}

}  // namespace articap
