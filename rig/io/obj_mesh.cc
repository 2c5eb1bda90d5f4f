// SPDX-License-Identifier: MIT
#include "rig/io/obj_mesh.h"

#include <fmt/format.h>

#include <iterator>
#include <map>

#include "core/check.h"
#include "rig/io/text_scan.h"

namespace articap {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, std::string_view source) : lines_(text), source_(source) {}

  Result<ObjMesh> Read() {
    std::string_view line;
    while (lines_.Next(line)) {
      SplitAtBlanks(line, fields_);
      if (fields_.empty()) continue;
      const std::string_view keyword = fields_[0];
      Result<void> read;
      if (keyword == "v") read = ReadVertex();
      if (keyword == "f") read = ReadFace();
      if (keyword == "g" || keyword == "o") ReadGroup(line, keyword);
      if (!read) return tl::unexpected(read.error());
    }
    if (mesh_.vertices.empty())
      return Fail(fmt::format("{}: holds no vertices; is it an OBJ file?", source_));
    if (!mesh_.colors.empty() && mesh_.colors.size() != mesh_.vertices.size())
      return Fail(fmt::format("{}: {} of {} vertices have a colour; give all of them one, or none",
                              source_, mesh_.colors.size(), mesh_.vertices.size()));
    return std::move(mesh_);
  }

 private:
  tl::unexpected<Error> Fault(std::string_view what) const {
    return Fail(fmt::format("{}, line {}: {}", source_, lines_.line_number(), what));
  }

  // x y z, optionally with a weight (4 numbers) or a colour (6).
  Result<void> ReadVertex() {
    const std::size_t count = fields_.size() - 1;
    if (count != 3 && count != 4 && count != 6)
      return Fault(fmt::format("a vertex of {} numbers; expected x y z, or x y z r g b", count));
    double values[6];
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = ParseNumber(fields_[i + 1]);
      if (!value) return Fault(fmt::format("'{}' is not a finite number", fields_[i + 1]));
      values[i] = *value;
    }
    mesh_.vertices.emplace_back(values[0], values[1], values[2]);
    if (count == 6) {
      const Eigen::Vector3d color(values[3], values[4], values[5]);
      if (color.minCoeff() < 0 || color.maxCoeff() > 1)
        return Fault("a colour that is not between 0 and 1");
      mesh_.colors.emplace_back(color.cast<float>());
    }
    return {};
  }

  Result<void> ReadFace() {
    if (fields_.size() < 4) return Fault("a face with fewer than three corners");
    if (mesh_.group_names.empty()) EnterGroup("");
    mesh_.faces.push_back({static_cast<int>(mesh_.corners.size()),
                           static_cast<int>(fields_.size() - 1), current_group_});
    const int num_vertices = static_cast<int>(mesh_.vertices.size());
    for (std::size_t i = 1; i < fields_.size(); ++i) {
      const std::string_view text = fields_[i].substr(0, fields_[i].find('/'));
      const auto number = ParseInteger(text);
      // From 1 forwards, or from -1 backwards from the newest vertex.
      const int vertex = !number ? -1 : *number > 0 ? *number - 1 : *number + num_vertices;
      if (!number || *number == 0 || vertex < 0 || vertex >= num_vertices)
        return Fault(fmt::format("a face names vertex '{}', of {} so far", text, num_vertices));
      mesh_.corners.push_back(vertex);
    }
    return {};
  }

  void ReadGroup(std::string_view line, std::string_view keyword) {
    line.remove_prefix(static_cast<std::size_t>(keyword.data() + keyword.size() - line.data()));
    while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
    while (!line.empty() && (line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
    EnterGroup(std::string(line));
  }

  void EnterGroup(const std::string& name) {
    const auto [entry, is_new] =
        groups_.try_emplace(name, static_cast<int>(mesh_.group_names.size()));
    if (is_new) mesh_.group_names.push_back(name);
    current_group_ = entry->second;
  }

  LineScanner lines_;
  std::string_view source_;
  std::vector<std::string_view> fields_;
  std::map<std::string, int> groups_;
  int current_group_ = 0;
  ObjMesh mesh_;
};

}  // namespace

Result<ObjMesh> ParseObj(std::string_view text, std::string_view source) {
  return ObjReader(text, source).Read();
}

void AppendTriangles(const std::vector<Eigen::Vector3d>& vertices, const int* corners,
                     int num_corners, std::vector<Eigen::Vector3i>& triangles) {
  if (num_corners == 4) {
    const double first = (vertices[corners[0]] - vertices[corners[2]]).squaredNorm();
    const double second = (vertices[corners[1]] - vertices[corners[3]]).squaredNorm();
    if (second < first) {
      triangles.emplace_back(corners[0], corners[1], corners[3]);
      triangles.emplace_back(corners[1], corners[2], corners[3]);
      return;
    }
  }
  for (int i = 2; i < num_corners; ++i)
    triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
}

std::string ObjText(const std::vector<Eigen::Vector3d>& vertices,
                    const std::vector<Eigen::Vector3i>& triangles,
                    const std::vector<Eigen::Vector3f>& colors,
                    const std::vector<std::string>& triangle_groups) {
  ARTICAP_CHECK_EQ(colors.size(), vertices.size());
  ARTICAP_CHECK_EQ(triangle_groups.size(), triangles.size());
  std::string text;
  text.reserve(80 * vertices.size() + 20 * triangles.size());
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    fmt::format_to(out, "v {} {} {} {} {} {}\n", vertices[i].x(), vertices[i].y(), vertices[i].z(),
                   colors[i].x(), colors[i].y(), colors[i].z());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i == 0 || triangle_groups[i] != triangle_groups[i - 1])
      fmt::format_to(out, "g {}\n", triangle_groups[i]);
    fmt::format_to(out, "f {} {} {}\n", triangles[i][0] + 1, triangles[i][1] + 1,
                   triangles[i][2] + 1);
  }
  return text;
}

}  // namespace articap
