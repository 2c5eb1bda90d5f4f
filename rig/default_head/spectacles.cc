// SPDX-License-Identifier: MIT
#include "rig/default_head/spectacles.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "rig/default_head/palette.h"

namespace articap::default_head {
namespace {

using Eigen::Vector3d;

constexpr int kSides = 5;  // of a bar's cross-section

// A bar along a path; closed paths end where they begin. Radii in mm across and along `flat`.
void AddBar(const std::vector<Vector3d>& path, bool closed, double radius_mm, HalfMesh& half) {
  const int size = static_cast<int>(path.size());
  std::vector<std::vector<int>> rings;
  for (int i = 0; i < size; ++i) {
    const Vector3d& before = path[closed ? (i + size - 1) % size : std::max(i - 1, 0)];
    const Vector3d& after = path[closed ? (i + 1) % size : std::min(i + 1, size - 1)];
    const Vector3d tangent = (after - before).normalized();
    const Vector3d reference = std::abs(tangent.z()) < 0.8 ? Vector3d::UnitZ() : Vector3d::UnitY();
    const Vector3d u = tangent.cross(reference).normalized();
    const Vector3d v = tangent.cross(u);
    rings.emplace_back();
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5) / kSides;
      Vector3d p = path[i] + radius_mm * (std::cos(angle) * u + std::sin(angle) * v);
      if (path[i].x() == 0) p.x() = 0;
      rings.back().push_back(
          half.AddVertex(p, LinearRgb(palette::kSpectacles), Part::kSpectacles, Carrier::kSkull));
    }
  }
  for (int i = 0; i + (closed ? 0 : 1) < size; ++i)
    for (int k = 0; k < kSides; ++k) {
      const std::vector<int>& a = rings[i];
      const std::vector<int>& b = rings[(i + 1) % size];
      const int next = (k + 1) % kSides;
      half.AddQuad(a[k], a[next], b[next], b[k], Part::kSpectacles, Region::kSpectacles);
    }
}

// A marker as an octahedron; the half of one where it sits on the midline. Returns its front
// vertex.
int AddMarker(const Vector3d& center, HalfMesh& half) {
  constexpr double kRadius_mm = 2;  // markers of 4 mm
  const auto add = [&](double x, double y, double z) {
    return half.AddVertex(center + kRadius_mm * Vector3d(x, y, z),
                          LinearRgb(palette::kSpectacleMarker), Part::kSpectacles, Carrier::kSkull);
  };
  const int front = add(0, 0, 1), back = add(0, 0, -1), up = add(0, 1, 0), down = add(0, -1, 0);
  const int left = add(1, 0, 0);
  const auto face = [&](int a, int b, int c) {
    half.AddTriangle(a, b, c, Part::kSpectacles, Region::kSpectacles);
  };
  face(front, left, up), face(front, down, left), face(back, up, left), face(back, left, down);
  if (center.x() > 0) {
    const int right = add(-1, 0, 0);
    face(front, up, right), face(front, right, down), face(back, right, up),
        face(back, down, right);
  }
  return front;
}

Vector3d RimPoint(double angle) {
  constexpr double kCenterX = 33, kCenterY = 12, kHalfWidth = 24.5, kHalfHeight = 20;
  const auto rounded = [](double c) { return std::copysign(std::pow(std::abs(c), 0.75), c); };
  const double x = kCenterX + kHalfWidth * rounded(std::cos(angle));
  const double y = kCenterY + kHalfHeight * rounded(std::sin(angle));
  // Wraps round the face, and leans in towards the cheek.
  return {x, y, 103.5 - 0.0042 * x * x + 0.10 * (y - kCenterY)};
}

}  // namespace

std::array<int, 3> AddSpectacles(HalfMesh& half) {
  constexpr int kRimPoints = 24;
  constexpr double kBarRadius_mm = 1.3;
  std::vector<Vector3d> rim;
  for (int i = 0; i < kRimPoints; ++i)
    rim.push_back(RimPoint(2 * std::numbers::pi * i / kRimPoints));
  AddBar(rim, true, kBarRadius_mm, half);
  const Vector3d bridge(0, 20, 105.5);
  AddBar({RimPoint(2.55), Vector3d(5, 19.4, 105.0), bridge}, false, kBarRadius_mm, half);
  const Vector3d corner = RimPoint(0.55);
  const std::vector<Vector3d> temple{corner,          {64, 22.5, 86}, {70.5, 23, 74},
                                     {74, 23.5, 50},  {76.5, 24, 20}, {78.5, 24, 0},
                                     {78.5, 22, -14}, {78, 8, -31}};
  AddBar(temple, false, kBarRadius_mm, half);
  const Vector3d on_temple = temple[3] + Vector3d(2.5, 0, 0);
  return {AddMarker(bridge + Vector3d(0, 0, 2.5), half),
          AddMarker(corner + Vector3d(0, 0, 2.5), half), AddMarker(on_temple, half)};
}

}  // namespace articap::default_head
