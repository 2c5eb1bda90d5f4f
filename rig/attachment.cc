// SPDX-License-Identifier: MIT
#include "rig/attachment.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <map>

namespace articap {
namespace {

// A triangle thinner than this cannot carry coordinates, mm^2.
constexpr double kLeastArea_mm2 = 1e-3;

}  // namespace

std::optional<int> RegionOfVertex(const FaceRig& rig, int vertex) {
  std::map<int, int> votes;
  const auto& triangles = rig.neutral_mesh().triangles;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if ((triangles[i].array() == vertex).any()) ++votes[rig.definition().triangle_region[i]];
  if (votes.empty()) return std::nullopt;
  return std::max_element(votes.begin(), votes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

Eigen::Vector3d ClosestPointOfTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double scale = 1 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

Attacher::Attacher(const FaceRig& rig, const Eigen::VectorXd& parameters)
    : rig_(rig),
      posed_{rig.Evaluate(parameters), rig.neutral_mesh().triangles},
      normals_(VertexNormals(posed_)) {}

// q = v1 + s (v2 - v1) + t (v3 - v1) + u e1 is linear in (s, t, u).
std::optional<VirtualMarker> Attacher::Solve(const std::string& name,
                                             const Eigen::Vector3i& triangle, int first_corner,
                                             const Eigen::Vector3d& point_in_rig) const {
  const Eigen::Vector3i corners(triangle[first_corner], triangle[(first_corner + 1) % 3],
                                triangle[(first_corner + 2) % 3]);
  const Eigen::Vector3d& v1 = posed_.vertices[corners[0]];
  Eigen::Matrix3d basis;
  basis << posed_.vertices[corners[1]] - v1, posed_.vertices[corners[2]] - v1, normals_[corners[0]];
  if (std::abs(basis.determinant()) < 2 * kLeastArea_mm2) return std::nullopt;
  const Eigen::Vector3d stu = basis.inverse() * (point_in_rig - v1);
  return VirtualMarker{name, corners, stu[0], stu[1], stu[2]};
}

template <class Accept>
std::optional<VirtualMarker> Attacher::AttachToNearest(const std::string& name,
                                                       const Eigen::Vector3d& point_in_rig,
                                                       Accept accept) const {
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<VirtualMarker> attached;
  for (std::size_t i = 0; i < posed_.triangles.size(); ++i) {
    if (!accept(i)) continue;
    const Eigen::Vector3i& triangle = posed_.triangles[i];
    const Eigen::Vector3d point =
        ClosestPointOfTriangle(point_in_rig, posed_.vertices[triangle[0]],
                               posed_.vertices[triangle[1]], posed_.vertices[triangle[2]]);
    const double distance = (point - point_in_rig).squaredNorm();
    if (distance >= nearest) continue;
    // v1, whose normal carries u, is the corner nearest to the foot of the marker.
    int first_corner = 0;
    for (const int corner : {1, 2})
      if ((posed_.vertices[triangle[corner]] - point).squaredNorm() <
          (posed_.vertices[triangle[first_corner]] - point).squaredNorm())
        first_corner = corner;
    if (auto candidate = Solve(name, triangle, first_corner, point_in_rig)) {
      nearest = distance;
      attached = std::move(candidate);
    }
  }
  return attached;
}

std::optional<VirtualMarker> Attacher::AttachInRegion(const std::string& name, int region,
                                                      const Eigen::Vector3d& point_in_rig) const {
  const auto& regions = rig_.definition().triangle_region;
  return AttachToNearest(name, point_in_rig,
                         [&](std::size_t triangle) { return regions[triangle] == region; });
}

std::optional<VirtualMarker> Attacher::AttachAtVertex(const std::string& name, int vertex,
                                                      int region,
                                                      const Eigen::Vector3d& point_in_rig) const {
  const auto& regions = rig_.definition().triangle_region;
  return AttachToNearest(name, point_in_rig, [&](std::size_t triangle) {
    return regions[triangle] == region && (posed_.triangles[triangle].array() == vertex).any();
  });
}

double Attacher::DistanceToRegion(int region, const Eigen::Vector3d& point_in_rig) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < posed_.triangles.size(); ++i) {
    if (rig_.definition().triangle_region[i] != region) continue;
    const Eigen::Vector3i& triangle = posed_.triangles[i];
    nearest = std::min(nearest, (ClosestPointOfTriangle(point_in_rig, posed_.vertices[triangle[0]],
                                                        posed_.vertices[triangle[1]],
                                                        posed_.vertices[triangle[2]]) -
                                 point_in_rig)
                                    .squaredNorm());
  }
  return std::sqrt(nearest);
}

}  // namespace articap
