// SPDX-License-Identifier: MIT
#include "core/ply.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/check.h"

namespace articap {
namespace {

constexpr RgbColor kMeasured{220, 40, 40}, kVirtual{40, 90, 220};

// A comment ends with its line, so that names from files must not break it.
std::string OneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace

std::string WritePly(std::span<const PlyPoint> points, std::span<const std::string> comments) {
  std::string text = "ply\nformat ascii 1.0\n";
  for (const std::string& comment : comments) text += fmt::format("comment {}\n", OneLine(comment));
  std::vector<int> named;
  for (const PlyPoint& point : points) {
    if (std::ranges::find(named, point.marker_index) != named.end()) continue;
    named.push_back(point.marker_index);
    text += fmt::format("comment marker {} {}\n", point.marker_index, OneLine(point.name));
  }
  text += fmt::format(
      "element vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property int marker\nend_header\n",
      points.size());
  for (const PlyPoint& point : points) {
    ARTICAP_CHECK(point.point_mm.allFinite());
    text += fmt::format("{:.4f} {:.4f} {:.4f} {} {} {} {}\n", point.point_mm.x(),
                        point.point_mm.y(), point.point_mm.z(), point.color.red, point.color.green,
                        point.color.blue, point.marker_index);
  }
  return text;
}

std::string MarkersToPly(const HeadShape& measured, const Sim3d& rig_from_head,
                         std::span<const std::string> names,
                         std::span<const Eigen::Vector3d> virtual_in_rig_mm) {
  ARTICAP_CHECK_EQ(names.size(), virtual_in_rig_mm.size());
  std::vector<PlyPoint> points;
  int next_index = static_cast<int>(names.size());
  for (const NamedPoint& marker : measured.points) {
    const auto name = std::ranges::find(names, marker.name);
    const int index = name == names.end() ? next_index++ : static_cast<int>(name - names.begin());
    points.push_back({marker.name, rig_from_head * marker.point_in_head_mm, kMeasured, index});
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    points.push_back({names[i], virtual_in_rig_mm[i], kVirtual, static_cast<int>(i)});
  const std::string comments[] = {"articap markers, rig frame: mm, x left, y up, z forward",
                                  "red: as measured; blue: virtual markers of the rig"};
  return WritePly(points, comments);
}

}  // namespace articap
