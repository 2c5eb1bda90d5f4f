// SPDX-License-Identifier: MIT
#include "core/picture_region.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <system_error>

namespace articap {

bool PictureRegion::Contains(const Eigen::Vector2d& point_px) const {
  const Eigen::Vector2d inside = point_px - Eigen::Vector2d(left - 0.5, top - 0.5);
  return inside.x() >= 0 && inside.y() >= 0 && inside.x() < width && inside.y() < height;
}

Result<PictureRegion> ParsePictureRegion(const std::string& text) {
  PictureRegion region;
  const std::array<int*, 4> numbers = {&region.width, &region.height, &region.left, &region.top};
  const std::string ends = {'x', '+', '+', '\0'};
  const char* at = text.c_str();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto read = std::from_chars(at, end, *numbers[i]);
    if (read.ec != std::errc() || *read.ptr != ends[i] || *numbers[i] < (i < 2 ? 1 : 0))
      return Fail(fmt::format(
          "'{}' is no region; write WIDTHxHEIGHT+LEFT+TOP in px, as 640x720+640+0", text));
    at = read.ptr + 1;
  }
  return region;
}

std::string FormatPictureRegion(const PictureRegion& region) {
  return fmt::format("{}x{}+{}+{}", region.width, region.height, region.left, region.top);
}

}  // namespace articap
