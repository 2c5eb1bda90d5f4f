// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/result.h"

namespace articap {

// A rectangle of a camera's picture, whole pixels.
struct PictureRegion {
  int left = 0;  // its first column
  int top = 0;   // its first row
  int width = 0;
  int height = 0;

  bool Contains(const Eigen::Vector2d& point_px) const;
  bool operator==(const PictureRegion&) const = default;
};

// As X11 writes geometries: WIDTHxHEIGHT+LEFT+TOP, "640x720+640+0" for the right half of 1280x720.
Result<PictureRegion> ParsePictureRegion(const std::string& text);
std::string FormatPictureRegion(const PictureRegion& region);

}  // namespace articap
