// SPDX-License-Identifier: MIT
#include "synthetic/attachment.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace articap {
namespace {

// A point of a triangle as v1 + s (v2 - v1) + t (v3 - v1).
struct TrianglePoint {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  double s = 0;
  double t = 0;
};

// The point of a triangle that is nearest to `point` (Ericson 2005, Real-Time Collision Detection,
// 5.1.5).
TrianglePoint NearestOfTriangle(const Eigen::Vector3d& point, const Eigen::Vector3d& v1,
                                const Eigen::Vector3d& v2, const Eigen::Vector3d& v3) {
  const Eigen::Vector3d e2 = v2 - v1, e3 = v3 - v1;
  const auto at = [&](double s, double t) { return TrianglePoint{v1 + s * e2 + t * e3, s, t}; };
  const double d1 = e2.dot(point - v1), d2 = e3.dot(point - v1);
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  const double d3 = e2.dot(point - v2), d4 = e3.dot(point - v2);
  if (d3 >= 0 && d4 <= d3) return at(1, 0);
  const double c = d1 * d4 - d3 * d2;
  if (c <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
  const double d5 = e2.dot(point - v3), d6 = e3.dot(point - v3);
  if (d6 >= 0 && d5 <= d6) return at(0, 1);
  const double b = d5 * d2 - d1 * d6;
  if (b <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
  const double a = d3 * d6 - d5 * d4;
  if (a <= 0 && d4 >= d3 && d5 >= d6) {
    const double along = (d4 - d3) / (d4 - d3 + d5 - d6);
    return at(1 - along, along);
  }
  const double sum = a + b + c;
  return at(b / sum, c / sum);
}

bool HasVertex(const Eigen::Vector3i& triangle, int vertex) {
  return (triangle.array() == vertex).any();
}

// The triangle with its corners turned so that `corner` comes first; its winding stays.
Eigen::Vector3i TurnedTo(const Eigen::Vector3i& triangle, int corner) {
  return {triangle[corner], triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]};
}

// Regions in which the marker may lie: true by index.
std::vector<bool> AllowedRegions(const FaceRig& rig, int landmark_vertex,
                                 std::optional<int> region) {
  std::vector<bool> allowed(rig.definition().region_names.size(), false);
  if (region) {
    allowed[*region] = true;
    return allowed;
  }
  const auto& triangles = rig.neutral_mesh().triangles;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (HasVertex(triangles[i], landmark_vertex))
      allowed[rig.definition().triangle_region[i]] = true;
  return allowed;
}

std::optional<VirtualMarker> AttachNear(const FaceRig& rig, const Eigen::Vector3d& point_in_rig,
                                        const std::vector<bool>& allowed_regions) {
  const TriangleMesh& mesh = rig.neutral_mesh();
  double least_distance_mm = std::numeric_limits<double>::infinity();
  std::optional<VirtualMarker> nearest;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!allowed_regions[rig.definition().triangle_region[i]]) continue;
    const auto corner = [&](const Eigen::Vector3i& triangle, int k) -> const Eigen::Vector3d& {
      return mesh.vertices[triangle[k]];
    };
    Eigen::Vector3i triangle = mesh.triangles[i];
    TrianglePoint found = NearestOfTriangle(point_in_rig, corner(triangle, 0), corner(triangle, 1),
                                            corner(triangle, 2));
    const double distance_mm = (found.point_mm - point_in_rig).norm();
    if (!(distance_mm < least_distance_mm)) continue;
    // v1, whose normal carries the marker, is the corner with the largest share.
    const Eigen::Vector3d shares(1 - found.s - found.t, found.s, found.t);
    int first = 0;
    shares.maxCoeff(&first);
    least_distance_mm = distance_mm;
    nearest = VirtualMarker{"", TurnedTo(triangle, first), shares[(first + 1) % 3],
                            shares[(first + 2) % 3], 0};
  }
  return nearest;
}

Result<VirtualMarker> AttachRole(const FaceRig& rig, const MarkerRole& role,
                                 const Eigen::Vector3d& misplacement_mm) {
  const std::string& rig_name = rig.definition().name;
  const auto vertex = rig.FindLandmark(role.landmark);
  if (!vertex)
    return Fail(
        fmt::format("marker '{}' sits at landmark '{}', which the rig '{}' does not have; "
                    "use one of docs/landmarks.md",
                    role.name, role.landmark, rig_name));
  const auto region = rig.FindRegion(role.region);
  if (!role.region.empty() && !region)
    return Fail(fmt::format("marker '{}' lies in region '{}', which the rig '{}' does not have",
                            role.name, role.region, rig_name));
  auto attached = AttachNear(rig, rig.neutral_mesh().vertices[*vertex] + misplacement_mm,
                             AllowedRegions(rig, *vertex, region));
  if (!attached)
    return Fail(fmt::format("landmark '{}' of marker '{}' is not on a surface of the rig '{}'",
                            role.landmark, role.name, rig_name));
  attached->name = role.name;
  attached->u_mm = role.offset_mm;
  return *attached;
}

}  // namespace

std::optional<VirtualMarker> AttachToVertex(const FaceRig& rig, int vertex) {
  for (const Eigen::Vector3i& triangle : rig.neutral_mesh().triangles)
    for (int corner = 0; corner < 3; ++corner)
      if (triangle[corner] == vertex) return VirtualMarker{"", TurnedTo(triangle, corner), 0, 0, 0};
  return std::nullopt;
}

Result<std::vector<VirtualMarker>> AttachMarkers(const FaceRig& rig, const MarkerSet& set,
                                                 double misplacement_mm, RandomGenerator& random) {
  std::vector<VirtualMarker> attachments;
  for (const MarkerRole& role : set.markers) {
    const Eigen::Vector3d beside_mm = misplacement_mm * random.Uniform() * random.Direction();
    auto attached = AttachRole(rig, role, beside_mm);
    if (!attached) return tl::unexpected(attached.error());
    attachments.push_back(*std::move(attached));
  }
  return attachments;
}

}  // namespace articap
