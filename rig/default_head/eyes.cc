// SPDX-License-Identifier: MIT
#include "rig/default_head/eyes.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "rig/default_head/curve.h"
#include "rig/default_head/palette.h"

namespace articap::default_head {

using Eigen::Vector3d;
using Eigen::Vector3f;

int AddEyeball(HalfMesh& half) {
  constexpr int kSegments = 20;
  struct Ring {
    double degrees;  // from the axis of sight
    std::uint32_t color;
  };
  // Pupil 4 mm, iris 11.8 mm across.
  static constexpr Ring kRings[] = {{8.7, palette::kPupil},    {9.7, palette::kIris},
                                    {17, palette::kIris},      {24.5, palette::kIris},
                                    {26.0, palette::kIrisRim}, {28.2, palette::kSclera},
                                    {50, palette::kSclera},    {80, palette::kSclera}};
  const Vector3d center(face::kPupilX, face::kPupilY, face::kEyeZ);
  const int pivot =
      half.AddVertex(center, LinearRgb(palette::kSclera), Part::kEyes, Carrier::kSkull);
  const int front = half.AddVertex(center + Vector3d(0, 0, face::kEyeRadius),
                                   LinearRgb(palette::kPupil), Part::kEyes, Carrier::kSkull);
  std::vector<int> inner(kSegments, front);
  for (const Ring& ring : kRings) {
    const double polar = ring.degrees * std::numbers::pi / 180;
    std::vector<int> outer;
    for (int k = 0; k < kSegments; ++k) {
      const double around = 2 * std::numbers::pi * k / kSegments;
      const Vector3d direction(std::sin(polar) * std::cos(around),
                               std::sin(polar) * std::sin(around), std::cos(polar));
      Vector3f color = LinearRgb(ring.color);
      // A calm grain, so that the iris is not one flat disc.
      if (ring.color == palette::kIris) color *= (k % 2 == 0) ? 1.12f : 0.88f;
      outer.push_back(half.AddVertex(center + face::kEyeRadius * direction, color, Part::kEyes,
                                     Carrier::kSkull));
    }
    for (int k = 0; k < kSegments; ++k) {
      const int next = (k + 1) % kSegments;
      half.AddQuad(inner[k], outer[k], outer[next], inner[next], Part::kEyes, Region::kEyes);
    }
    inner = outer;
  }
  return pivot;
}

void AddBrow(const FaceShape& shape, HalfMesh& half) {
  constexpr int kAlong = 14;
  constexpr int kAcross = 4;
  static const Curve kMiddle{{9.5, 28.5}, {16, 30.8}, {26, 33.8},
                             {36, 35.4},  {44, 33.8}, {50, 30.5}};
  static const Curve kHalfWidth{{9.5, 2.4}, {14, 3.6}, {26, 3.4}, {38, 2.5}, {45, 1.6}, {50, 0.5}};
  std::vector<std::vector<int>> rows;
  for (int i = 0; i <= kAlong; ++i) {
    const double x = 9.5 + (50 - 9.5) * i / kAlong;
    rows.emplace_back();
    for (int j = 0; j <= kAcross; ++j) {
      const double v = 2.0 * j / kAcross - 1;
      Vector3d p = shape.InFront(x + 0.8 * v, kMiddle(x) + v * kHalfWidth(x));
      // A cushion that thins out towards its ends.
      p.z() +=
          1.5 * (1 - v * v) * SmoothStep(-1, 2.5, i) * SmoothStep(kAlong + 1, kAlong - 3, i) + 0.15;
      rows.back().push_back(
          half.AddVertex(p, LinearRgb(palette::kBrow), Part::kBrows, Carrier::kSkull));
    }
  }
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAcross; ++j)
      half.AddQuad(rows[i][j], rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1], Part::kBrows,
                   Region::kSkull);
}

}  // namespace articap::default_head
