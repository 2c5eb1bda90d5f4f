// SPDX-License-Identifier: MIT
#include "rig/io/region_rules.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace articap {
namespace {

constexpr int kUnassigned = -1;

// Even-odd rule.
bool IsInside(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[j];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

bool IsOneOf(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

using Ways = std::map<std::string, std::vector<double>>;

bool Fits(const ImportRecipe::Region& rule, const Ways& ways_mm, const RigDefinition& rig,
          std::size_t triangle) {
  if (!IsOneOf(rule.parts, rig.part_names[rig.triangle_part[triangle]])) return false;
  const Eigen::Vector3i& corners = rig.mesh.triangles[triangle];
  const Eigen::Vector3d& v1 = rig.mesh.vertices[corners[0]];
  const Eigen::Vector3d& v2 = rig.mesh.vertices[corners[1]];
  const Eigen::Vector3d& v3 = rig.mesh.vertices[corners[2]];
  const Eigen::Vector3d center_mm = (v1 + v2 + v3) / 3;
  if (rule.side * center_mm.x() < 0) return false;
  if (rule.facing && (v2 - v1).cross(v3 - v1).dot(*rule.facing) <= 0) return false;
  if (rule.moved_by) {
    const std::vector<double>& way_mm = ways_mm.at(rule.moved_by->target);
    const double mean_mm = (way_mm[corners[0]] + way_mm[corners[1]] + way_mm[corners[2]]) / 3;
    if (mean_mm < rule.moved_by->range_mm[0] || mean_mm >= rule.moved_by->range_mm[1]) return false;
  }
  if (rule.depth_mm && (center_mm.z() < (*rule.depth_mm)[0] || center_mm.z() > (*rule.depth_mm)[1]))
    return false;
  return rule.outline_mm.empty() ||
         IsInside(rule.outline_mm, {std::abs(center_mm.x()), center_mm.y()});
}

// Triangles that share an edge.
std::vector<std::vector<int>> FindNeighbours(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> triangles_of_edge;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[i][k];
      const int b = mesh.triangles[i][(k + 1) % 3];
      triangles_of_edge[std::minmax(a, b)].push_back(static_cast<int>(i));
    }
  std::vector<std::vector<int>> neighbours(mesh.triangles.size());
  for (const auto& [edge, triangles] : triangles_of_edge)
    for (const int from : triangles)
      for (const int to : triangles)
        if (from != to) neighbours[from].push_back(to);
  return neighbours;
}

// Everything unassigned that can be reached over edges from the triangles around a vertex.
void Fill(const TriangleMesh& mesh, int vertex, int region, std::vector<int>& region_of) {
  const std::vector<std::vector<int>> neighbours = FindNeighbours(mesh);
  std::vector<int> pending;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if ((mesh.triangles[i].array() == vertex).any()) pending.push_back(static_cast<int>(i));
  while (!pending.empty()) {
    const int triangle = pending.back();
    pending.pop_back();
    if (region_of[triangle] != kUnassigned) continue;
    region_of[triangle] = region;
    pending.insert(pending.end(), neighbours[triangle].begin(), neighbours[triangle].end());
  }
}

int IndexOfName(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    names.push_back(name);
    return static_cast<int>(names.size()) - 1;
  }
  return static_cast<int>(found - names.begin());
}

}  // namespace

Result<void> AssignRegions(const std::vector<ImportRecipe::Region>& rules,
                           const std::vector<int>& vertex_of_source, const Ways& ways_mm,
                           RigDefinition& rig) {
  std::vector<int> region_of(rig.mesh.triangles.size(), kUnassigned);
  for (const ImportRecipe::Region& rule : rules) {
    const int region = IndexOfName(rig.region_names, rule.name);
    if (rule.fill_from) {
      const int source = *rule.fill_from;
      if (source < 0 || source >= static_cast<int>(vertex_of_source.size()) ||
          vertex_of_source[source] < 0)
        return Fail(
            fmt::format("the region '{}' is filled from vertex {}, which the rig does not have",
                        rule.name, source));
      Fill(rig.mesh, vertex_of_source[source], region, region_of);
    } else {
      for (std::size_t i = 0; i < region_of.size(); ++i)
        if (region_of[i] == kUnassigned && Fits(rule, ways_mm, rig, i)) region_of[i] = region;
    }
    if (rule.color)
      for (std::size_t i = 0; i < region_of.size(); ++i)
        if (region_of[i] == region)
          for (const int corner : rig.mesh.triangles[i]) rig.colors[corner] = *rule.color;
  }
  if (std::count(region_of.begin(), region_of.end(), kUnassigned) > 0) {
    const int other = IndexOfName(rig.region_names, rules.empty() ? "face" : "other");
    std::replace(region_of.begin(), region_of.end(), kUnassigned, other);
  }
  if (rig.region_names.size() > 256) return Fail("a rig has at most 256 regions");
  rig.triangle_region.assign(region_of.begin(), region_of.end());
  return {};
}

}  // namespace articap
