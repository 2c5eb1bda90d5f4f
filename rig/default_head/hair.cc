// SPDX-License-Identifier: MIT
#include "rig/default_head/hair.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "rig/default_head/curve.h"
#include "rig/default_head/palette.h"

namespace articap::default_head {

using Eigen::Vector3d;
using Eigen::Vector3f;

void AddHair(const FaceShape& shape, HalfMesh& half) {
  constexpr int kColumns = 42;
  constexpr double kThickness_mm = 7.5;
  // From the hairline (0) to the crown (1); denser at the edge, where the hair rises from the skin.
  static constexpr double kRows[] = {0, 0.01, 0.05, 0.13, 0.25, 0.39, 0.52, 0.64, 0.75, 0.85, 0.94};
  const BaseSurface& base = shape.base();
  const Vector3f color = LinearRgb(palette::kHair);
  std::vector<std::vector<int>> rows;
  for (const double along : kRows) {
    rows.emplace_back();
    for (int c = 0; c <= kColumns; ++c) {
      // Denser at the temple and round the ear, where the hairline bends.
      const double u = c / static_cast<double>(kColumns);
      const double s = BaseSurface::kBackSection * (u - 0.045 * std::sin(2 * std::numbers::pi * u));
      const double line = FaceShape::Hairline(s);
      const double t = line + along * (BaseSurface::kCrownLevel - line);
      const double top = SmoothStep(10.5, 14, t);
      // The edge sinks into the skin and rises steeply, so that the hairline is where it is drawn.
      const double thick = (0.30 + 0.70 * top) * SmoothStep(-0.03, 0.17, along);
      const double lift_mm = along == 0 ? -2.0 : 0.8 + kThickness_mm * thick;
      Vector3d p = base.At(s, t) + lift_mm * base.Outward(s, t);
      if (c == 0 || c == kColumns) p.x() = 0;
      p.x() = std::max(p.x(), 0.0);
      rows.back().push_back(half.AddVertex(p, color, Part::kHair, Carrier::kSkull));
    }
  }
  const Vector3d crown = base.At(0, BaseSurface::kCrownLevel) + Vector3d(0, kThickness_mm, 0);
  rows.emplace_back(kColumns + 1,
                    half.AddVertex({0, crown.y(), crown.z()}, color, Part::kHair, Carrier::kSkull));
  for (std::size_t r = 0; r + 1 < rows.size(); ++r)
    for (int c = 0; c < kColumns; ++c)
      half.AddQuad(rows[r][c], rows[r][c + 1], rows[r + 1][c + 1], rows[r + 1][c], Part::kHair,
                   Region::kSkull);
}

}  // namespace articap::default_head
