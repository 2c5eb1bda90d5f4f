// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

// Named positions in the head frame, mm: the reference shape that all takes of a speaker share.
struct NamedPoint {
  std::string name;
  Eigen::Vector3d point_in_head_mm = Eigen::Vector3d::Zero();
};

struct HeadShape {
  std::vector<NamedPoint> points;
  const NamedPoint* Find(std::string_view name) const;
};

// CSV with the columns name,x_mm,y_mm,z_mm.
std::string WriteHeadShapeCsv(const HeadShape& shape);
Result<HeadShape> ParseHeadShapeCsv(const std::string& text, const std::string& source_name);
Result<HeadShape> ReadHeadShapeCsv(const std::filesystem::path& path);

}  // namespace articap
