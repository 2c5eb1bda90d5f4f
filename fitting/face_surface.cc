// SPDX-License-Identifier: MIT
#include "fitting/face_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "rig/attachment.h"

namespace articap {
namespace {

constexpr std::array<std::string_view, 7> kPartsWithoutMarkers = {
    "hair", "brows", "eyes", "teeth", "gums", "tongue", "spectacles"};
constexpr std::array<std::string_view, 7> kRegionsWithoutMarkers = {
    "neck", "inside", "teeth_upper", "teeth_lower", "tongue", "eyes", "spectacles"};

// Triangles smaller than this have no normal to speak of, mm^2.
constexpr double kLeastArea_mm2 = 1e-4;

bool IsOneOf(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

// The rig's origin lies between the ears, so that the face is what has positive z.
bool IsFace(const FaceRig& rig, std::size_t triangle) {
  const RigDefinition& definition = rig.definition();
  if (IsOneOf(kPartsWithoutMarkers, definition.part_names[definition.triangle_part[triangle]]) ||
      IsOneOf(kRegionsWithoutMarkers,
              definition.region_names[definition.triangle_region[triangle]]))
    return false;
  const Eigen::Vector3i& corners = rig.neutral_mesh().triangles[triangle];
  const auto& vertices = rig.neutral_mesh().vertices;
  return vertices[corners[0]].z() + vertices[corners[1]].z() + vertices[corners[2]].z() > 0;
}

bool IsSpectacles(const FaceRig& rig, std::size_t triangle) {
  const RigDefinition& definition = rig.definition();
  return definition.part_names[definition.triangle_part[triangle]] == "spectacles";
}

}  // namespace

Result<FaceSurface> FaceSurface::Create(const FaceRig& rig) {
  FaceSurface surface;
  const TriangleMesh& mesh = rig.neutral_mesh();
  std::vector<bool> carries_markers(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool is_face = IsFace(rig, i);
    if (!is_face && !IsSpectacles(rig, i)) continue;
    const Eigen::Vector3i& corners = mesh.triangles[i];
    for (int corner = 0; corner < 3; ++corner) carries_markers[corners[corner]] = true;
    if (!is_face) continue;
    Facet facet{.a = mesh.vertices[corners[0]],
                .b = mesh.vertices[corners[1]],
                .c = mesh.vertices[corners[2]]};
    facet.normal = (facet.b - facet.a).cross(facet.c - facet.a);
    if (facet.normal.norm() < 2 * kLeastArea_mm2) continue;
    facet.normal.normalize();
    facet.center = (facet.a + facet.b + facet.c) / 3;
    facet.radius_mm = std::max({(facet.a - facet.center).norm(), (facet.b - facet.center).norm(),
                                (facet.c - facet.center).norm()});
    facet.region = rig.definition().triangle_region[i];
    surface.facets_.push_back(facet);
  }
  if (surface.facets_.empty())
    return Fail(
        fmt::format("the rig '{}' has no skin in front of its origin, where a face would be",
                    rig.definition().name));
  for (const Landmark& landmark : rig.definition().landmarks)
    if (carries_markers[landmark.vertex])
      surface.places_.push_back({landmark.name, mesh.vertices[landmark.vertex]});
  return surface;
}

FaceSurface::Foot FaceSurface::Nearest(const Eigen::Vector3d& point_in_rig) const {
  Foot foot;
  foot.distance_mm = std::numeric_limits<double>::infinity();
  for (const Facet& facet : facets_) {
    const double reach_mm = foot.distance_mm + facet.radius_mm;
    if ((facet.center - point_in_rig).squaredNorm() > reach_mm * reach_mm) continue;
    const Eigen::Vector3d point = ClosestPointOfTriangle(point_in_rig, facet.a, facet.b, facet.c);
    const double distance_mm = (point - point_in_rig).norm();
    if (distance_mm < foot.distance_mm) foot = {point, facet.normal, facet.region, distance_mm};
  }
  return foot;
}

std::vector<Eigen::Vector3d> FaceSurface::Sample(double spacing_mm) const {
  std::vector<Eigen::Vector3d> samples;
  for (const Facet& facet : facets_) {
    const Eigen::Vector3d ab = facet.b - facet.a, ac = facet.c - facet.a;
    const double longest_mm = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    // The centres of n^2 equal triangles: n (n + 1) / 2 upright ones, the others turned over.
    const int n = std::max(1, static_cast<int>(std::ceil(longest_mm / spacing_mm)));
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        samples.push_back(facet.a + (i + 1 / 3.0) / n * ab + (j + 1 / 3.0) / n * ac);
        if (i + j + 1 < n)
          samples.push_back(facet.a + (i + 2 / 3.0) / n * ab + (j + 2 / 3.0) / n * ac);
      }
  }
  return samples;
}

}  // namespace articap
