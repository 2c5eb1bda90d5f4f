// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"

namespace articap {

// What the texts among DotDetectorOptions say.

// RGB, 0 to 1; nothing for an empty text.
Result<std::optional<Eigen::Vector3f>> ParseDotColor(const std::string& text);

// A polygon of the camera's picture; its sides may cross (even-odd rule).
struct DotRegion {
  std::vector<Eigen::Vector2d> corners_px;

  bool Contains(const Eigen::Vector2d& point_px) const;
};
Result<DotRegion> ParseRegion(const std::string& text);

}  // namespace articap
