// SPDX-License-Identifier: MIT
#include "core/head_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/csv_rows.h"
#include "core/csv_values.h"
#include "core/file_io.h"

namespace articap {
namespace {

constexpr std::array<std::string_view, 4> kColumns = {"name", "x_mm", "y_mm", "z_mm"};

Result<NamedPoint> ParsePoint(const std::vector<std::string_view>& cells,
                              const std::string& where) {
  if (cells.size() != kColumns.size())
    return Fail(fmt::format("{}: {} cells; write name,x_mm,y_mm,z_mm", where, cells.size()));
  NamedPoint point{std::string(cells[0]), {}};
  if (point.name.empty()) return Fail(fmt::format("{}: the point has no name", where));
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = ParseFinite(cells[axis + 1]);
    if (!value)
      return Fail(fmt::format("{}: {} of '{}' is '{}', not a number of mm", where,
                              kColumns[axis + 1], point.name, cells[axis + 1]));
    point.point_in_head_mm[axis] = *value;
  }
  return point;
}

}  // namespace

const NamedPoint* HeadShape::Find(std::string_view name) const {
  const auto found = std::find_if(points.begin(), points.end(),
                                  [&](const NamedPoint& point) { return point.name == name; });
  return found == points.end() ? nullptr : &*found;
}

std::string WriteHeadShapeCsv(const HeadShape& shape) {
  std::string text = "name,x_mm,y_mm,z_mm\n";
  for (const auto& [name, point] : shape.points)
    text += fmt::format("{},{},{},{}\n", CsvCell(name), point.x(), point.y(), point.z());
  return text;
}

Result<HeadShape> ParseHeadShapeCsv(const std::string& text, const std::string& source_name) {
  CsvRows rows(text, source_name);
  std::vector<std::string_view> cells;
  const auto has_header = rows.Next(cells);
  if (!has_header) return tl::unexpected(has_header.error());
  if (!*has_header || !std::ranges::equal(cells, kColumns))
    return Fail(fmt::format("{}: not a head shape: its first line must be name,x_mm,y_mm,z_mm",
                            source_name));
  HeadShape shape;
  while (true) {
    const auto has_row = rows.Next(cells);
    if (!has_row) return tl::unexpected(has_row.error());
    if (!*has_row) break;
    auto point = ParsePoint(cells, rows.Where());
    if (!point) return tl::unexpected(point.error());
    if (shape.Find(point->name))
      return Fail(fmt::format("{}: '{}' is there twice", rows.Where(), point->name));
    shape.points.push_back(std::move(*point));
  }
  if (shape.points.empty()) return Fail(fmt::format("{}: the shape has no points", source_name));
  return shape;
}

Result<HeadShape> ReadHeadShapeCsv(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseHeadShapeCsv(*text, path.string());
}

}  // namespace articap
