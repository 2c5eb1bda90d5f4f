// SPDX-License-Identifier: MIT
#include "render/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace articap {
namespace {

constexpr double kPlate_mm = 3;
// Lines of a pattern nearer than this are one line, computed in two ways.
constexpr double kSameLine_mm = 1e-6;
constexpr int kRodSides = 24;

// Four corners counter-clockwise seen from outside, with vertices of their own: flat, of one
// colour.
void AddFace(const std::array<Eigen::Vector3d, 4>& corners, const Eigen::Vector3f& color,
             RenderMesh& mesh) {
  const int first = static_cast<int>(mesh.mesh.vertices.size());
  mesh.mesh.vertices.insert(mesh.mesh.vertices.end(), corners.begin(), corners.end());
  mesh.colors.insert(mesh.colors.end(), 4, color);
  mesh.mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.mesh.triangles.emplace_back(first, first + 2, first + 3);
}

// Where lines along one axis (0: x) cut the pattern, ascending.
std::vector<double> CutsOf(const BoardPattern& pattern, int axis) {
  std::vector<double> cuts = {pattern.paper.min_mm[axis], pattern.paper.max_mm[axis]};
  for (const BoardRectangle& dark : pattern.dark) {
    cuts.push_back(dark.min_mm[axis]);
    cuts.push_back(dark.max_mm[axis]);
  }
  std::sort(cuts.begin(), cuts.end());
  const auto is_same = [](double a, double b) { return b - a < kSameLine_mm; };
  cuts.erase(std::unique(cuts.begin(), cuts.end(), is_same), cuts.end());
  return cuts;
}

bool IsDark(const BoardPattern& pattern, const Eigen::Vector2d& point_mm) {
  return std::any_of(pattern.dark.begin(), pattern.dark.end(), [&](const BoardRectangle& dark) {
    return (point_mm.array() > dark.min_mm.array()).all() &&
           (point_mm.array() < dark.max_mm.array()).all();
  });
}

// Back and sides; the board frame's z points into the plate.
void AddPlate(const BoardRectangle& paper, const Rigid3d& stage_from_board,
              const Eigen::Vector3f& color, RenderMesh& mesh) {
  const auto corner = [&](bool right, bool below, bool back) {
    return Eigen::Vector3d(stage_from_board *
                           Eigen::Vector3d((right ? paper.max_mm : paper.min_mm).x(),
                                           (below ? paper.max_mm : paper.min_mm).y(),
                                           back ? kPlate_mm : 0));
  };
  AddFace({corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)}, color, mesh);
  AddFace({corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1)}, color, mesh);
  AddFace({corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1)}, color, mesh);
  AddFace({corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1)}, color, mesh);
  AddFace({corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1)}, color, mesh);
}

}  // namespace

RenderMesh BoardMesh(const BoardPattern& pattern, const Rigid3d& stage_from_board, float white,
                     float black) {
  const std::vector<double> columns = CutsOf(pattern, 0);
  const std::vector<double> rows = CutsOf(pattern, 1);
  const auto corner = [&](std::size_t column, std::size_t row) {
    return Eigen::Vector3d(stage_from_board * Eigen::Vector3d(columns[column], rows[row], 0));
  };
  RenderMesh mesh;
  mesh.material = {.gloss = 0};
  for (std::size_t row = 0; row + 1 < rows.size(); ++row)
    for (std::size_t column = 0; column + 1 < columns.size(); ++column) {
      const Eigen::Vector2d middle((columns[column] + columns[column + 1]) / 2,
                                   (rows[row] + rows[row + 1]) / 2);
      AddFace({corner(column, row), corner(column, row + 1), corner(column + 1, row + 1),
               corner(column + 1, row)},
              Eigen::Vector3f::Constant(IsDark(pattern, middle) ? black : white), mesh);
    }
  AddPlate(pattern.paper, stage_from_board, Eigen::Vector3f::Constant(white), mesh);
  return mesh;
}

RenderMesh RodMesh(const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm,
                   const Eigen::Vector3f& color) {
  const Eigen::Vector3d axis = (to_mm - from_mm).normalized();
  const Eigen::Vector3d first = axis.unitOrthogonal();
  const Eigen::Vector3d second = axis.cross(first);
  RenderMesh rod;
  rod.material = {.gloss = 0};
  for (int side = 0; side < kRodSides; ++side) {
    const double angle = 2 * std::numbers::pi * side / kRodSides;
    const Eigen::Vector3d outwards = std::cos(angle) * first + std::sin(angle) * second;
    for (const Eigen::Vector3d& end : {from_mm, to_mm}) {
      rod.mesh.vertices.push_back(end + radius_mm * outwards);
      rod.normals.push_back(outwards);
    }
    const int here = 2 * side;
    const int next = 2 * ((side + 1) % kRodSides);
    rod.mesh.triangles.emplace_back(here, next, next + 1);
    rod.mesh.triangles.emplace_back(here, next + 1, here + 1);
  }
  rod.colors.assign(rod.mesh.vertices.size(), color);
  return rod;
}

}  // namespace articap
