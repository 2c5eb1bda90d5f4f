// SPDX-License-Identifier: MIT
#include "rig/default_head/half_mesh.h"

#include <cmath>
#include <iterator>

#include "core/check.h"

namespace articap {
namespace {

Region MirrorRegion(Region region) {
  return region == Region::kLeftCheek ? Region::kRightCheek : region;
}

Eigen::Vector3d MirrorPoint(const Eigen::Vector3d& point) {
  return {-point.x(), point.y(), point.z()};
}

}  // namespace

int HalfMesh::AddVertex(const Eigen::Vector3d& position, const Eigen::Vector3f& color, Part part,
                        Carrier carrier) {
  ARTICAP_CHECK_GE(position.x(), 0);
  vertices.push_back({position, color, part, carrier});
  return static_cast<int>(vertices.size()) - 1;
}

void HalfMesh::AddTriangle(int a, int b, int c, Part part, Region region) {
  if (a == b || b == c || c == a) return;  // rings that end in one vertex
  triangles.push_back({{a, b, c}, part, region});
}

void HalfMesh::AddQuad(int a, int b, int c, int d, Part part, Region region) {
  const double ac = (position(c) - position(a)).norm();
  const double bd = (position(d) - position(b)).norm();
  if (ac <= bd) {
    AddTriangle(a, b, c, part, region);
    AddTriangle(a, c, d, part, region);
  } else {
    AddTriangle(a, b, d, part, region);
    AddTriangle(b, c, d, part, region);
  }
}

MirrorMap MirrorHalf(const HalfMesh& half, RigDefinition& definition) {
  MirrorMap map;
  TriangleMesh& mesh = definition.mesh;
  const auto add = [&](const Eigen::Vector3d& position, const Eigen::Vector3f& color) {
    mesh.vertices.push_back(position);
    definition.colors.push_back(color);
    return static_cast<int>(mesh.vertices.size()) - 1;
  };
  for (const HalfMesh::Vertex& vertex : half.vertices) {
    map.left.push_back(add(vertex.position, vertex.color));
    const bool on_midline = vertex.position.x() == 0;
    map.right.push_back(on_midline ? map.left.back()
                                   : add(MirrorPoint(vertex.position), vertex.color));
  }
  const auto add_triangle = [&](int a, int b, int c, Part part, Region region) {
    mesh.triangles.emplace_back(a, b, c);
    definition.triangle_part.push_back(static_cast<std::uint8_t>(part));
    definition.triangle_region.push_back(static_cast<std::uint8_t>(region));
  };
  for (const HalfMesh::Triangle& triangle : half.triangles) {
    const Eigen::Vector3i& v = triangle.corners;
    add_triangle(map.left[v[0]], map.left[v[1]], map.left[v[2]], triangle.part, triangle.region);
    add_triangle(map.right[v[0]], map.right[v[2]], map.right[v[1]], triangle.part,
                 MirrorRegion(triangle.region));
  }
  definition.part_names.assign(std::begin(kPartNames), std::end(kPartNames));
  definition.region_names.assign(std::begin(kRegionNames), std::end(kRegionNames));
  return map;
}

Eigen::Vector3f LinearRgb(std::uint32_t srgb) {
  Eigen::Vector3f linear;
  for (int i = 0; i < 3; ++i) {
    const double encoded = static_cast<double>((srgb >> (16 - 8 * i)) & 0xff) / 255;
    // IEC 61966-2-1
    linear[i] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92
                                                      : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
  return linear;
}

}  // namespace articap
