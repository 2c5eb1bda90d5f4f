// SPDX-License-Identifier: MIT
#include "rig/default_head/mouth_parts.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "rig/default_head/curve.h"
#include "rig/default_head/palette.h"

namespace articap::default_head {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kTeeth = 6;  // a quadrant shows: two incisors, canine, premolars, a molar

struct Arch {
  // The labial surface is an ellipse about (0, kArchCenterZ).
  double half_width_mm, depth_mm;
  std::array<double, kTeeth> crown_widths_mm;  // mesiodistal
  double front_edge_y_mm, back_edge_y_mm;      // incisal edge, cusps
  double crown_mm;                             // height of the front crowns
  double up;                                   // where the gum is: 1 above, -1 below
  Region region;
  Carrier carrier;
};

constexpr double kArchCenterZ = 46;
constexpr Arch kUpper{27.5, 46.2, {8.6, 6.8, 7.6, 7.0, 6.8, 10}, -56.0,          -54.0,
                      10,   1,    Region::kTeethUpper,           Carrier::kSkull};
constexpr Arch kLower{25.3,
                      43.2,
                      {5.4, 5.9, 6.9, 7.0, 7.1, 11},
                      -53.4,
                      -55.2,
                      9,
                      -1,
                      Region::kTeethLower,
                      Carrier::kMandible};

// Point and outward normal of the labial arch after a length along it from the midline.
struct ArchPoint {
  Vector2d xz, outward;
};
ArchPoint AlongArch(const Arch& arch, double length_mm) {
  constexpr double kStep = 0.002;
  double angle = 0;
  for (double length = 0; length < length_mm; angle += kStep)
    length +=
        kStep * std::hypot(arch.half_width_mm * std::cos(angle), arch.depth_mm * std::sin(angle));
  if (length_mm == 0) angle = 0;
  const Vector2d outward(std::sin(angle) / arch.half_width_mm, std::cos(angle) / arch.depth_mm);
  return {{arch.half_width_mm * std::sin(angle), kArchCenterZ + arch.depth_mm * std::cos(angle)},
          outward.normalized()};
}

// One point of a tooth's cross-section in its gum, from the labial gum over the edge to the
// lingual.
struct ProfilePoint {
  double inward_mm;   // of an incisor
  double thickening;  // part of a molar's greater thickness
  double from_edge;   // in crown heights: 0 at the edge, 1 at the gum's margin
  bool gum;
};
constexpr ProfilePoint kProfile[] = {
    {2.6, 0, 1.7, true},    {-0.5, 0, 1.1, true},  {0.2, 0, 0.98, false}, {-0.1, 0, 0.5, false},
    {0.5, 0, 0.08, false},  {1.0, 0.1, 0, false},  {2.2, 1, 0.03, false}, {5.5, 0.8, 0.75, false},
    {7.0, 0.8, 1.15, true}, {7.0, 1.0, 1.75, true}};
constexpr int kProfileSize = static_cast<int>(std::size(kProfile));

struct ToothColumn {
  double along_mm;  // of the arch
  double gap;       // 1 between two teeth, 0 on a tooth
  double back;      // 0 at the incisors, 1 at the molar
};

std::vector<ToothColumn> ColumnsOf(const Arch& arch) {
  std::vector<ToothColumn> columns;
  double along = 0;
  for (int tooth = 0; tooth < kTeeth; ++tooth) {
    const double width = arch.crown_widths_mm[tooth];
    const double back = SmoothStep(1.5, 5, tooth);
    columns.push_back({along, 1, back});
    columns.push_back({along + 0.2 * width, 0, back});
    columns.push_back({along + 0.8 * width, 0, back});
    along += width;
  }
  columns.push_back({along, 1, 1});
  return columns;
}

// Adds a row of teeth; returns the vertex on the midline's edge.
int AddRow(const Arch& arch, HalfMesh& half) {
  std::vector<std::array<int, kProfileSize>> columns;
  for (const ToothColumn& column : ColumnsOf(arch)) {
    const ArchPoint at = AlongArch(arch, column.along_mm);
    const double edge_y =
        arch.front_edge_y_mm + column.back * (arch.back_edge_y_mm - arch.front_edge_y_mm);
    const double crown = arch.crown_mm * (1 - 0.3 * column.back);
    columns.emplace_back();
    for (int i = 0; i < kProfileSize; ++i) {
      const ProfilePoint& profile = kProfile[i];
      double inward = profile.inward_mm + 6.0 * column.back * profile.thickening;
      double from_edge = profile.from_edge * crown;
      if (!profile.gum) {  // a furrow between teeth, open at the edge
        inward += (i < 6 ? 0.7 : -0.5) * column.gap;
        from_edge += 0.6 * column.gap * (1 - profile.from_edge);
      } else if (i == 1 || i == 8) {  // the papilla reaches down between them
        from_edge -= 1.6 * column.gap;
      }
      const Vector2d xz = at.xz - inward * at.outward;
      const Vector3d p(column.along_mm == 0 ? 0 : xz.x(), edge_y + arch.up * from_edge, xz.y());
      Vector3f color = LinearRgb(profile.gum ? palette::kGum : palette::kTooth);
      if (!profile.gum)
        color += static_cast<float>(0.55 * column.gap) * (LinearRgb(palette::kToothGap) - color);
      columns.back()[i] =
          half.AddVertex(p, color, profile.gum ? Part::kGums : Part::kTeeth, arch.carrier);
    }
  }
  for (std::size_t c = 0; c + 1 < columns.size(); ++c)
    for (int i = 0; i + 1 < kProfileSize; ++i) {
      const Part part = kProfile[i].gum || kProfile[i + 1].gum ? Part::kGums : Part::kTeeth;
      const int a = columns[c][i], b = columns[c][i + 1];
      const int d = columns[c + 1][i], e = columns[c + 1][i + 1];
      if (arch.up > 0)
        half.AddQuad(a, b, e, d, part, arch.region);
      else
        half.AddQuad(a, d, e, b, part, arch.region);
    }
  return columns[0][5];
}

}  // namespace

Incisors AddTeeth(HalfMesh& half) {
  Incisors incisors;
  incisors.upper = AddRow(kUpper, half);
  incisors.lower = AddRow(kLower, half);
  return incisors;
}

void AddTongue(HalfMesh& half) {
  constexpr int kAlong = 9;
  constexpr int kAround = 7;
  static const Curve kWidth{{0, 0}, {0.05, 5.5}, {0.15, 10}, {0.35, 14}, {0.65, 17}, {1, 18}};
  static const Curve kThickness{{0, 0}, {0.05, 1.6}, {0.15, 2.6}, {0.4, 4.0}, {0.7, 5.5}, {1, 7}};
  static const Curve kMiddleY{{0, -61}, {0.2, -60.3}, {0.6, -60}, {1, -64}};
  const Vector3f tip = LinearRgb(palette::kTongue), root = LinearRgb(palette::kMouthInside);
  std::vector<int> before(
      kAround + 1, half.AddVertex({0, kMiddleY(0), 81}, tip, Part::kTongue, Carrier::kTongue));
  for (int i = 1; i <= kAlong; ++i) {
    const double t = std::pow(i / static_cast<double>(kAlong), 1.5);
    const Vector3f color = tip + static_cast<float>(SmoothStep(0.2, 1, t)) * (root - tip);
    std::vector<int> here;
    for (int j = 0; j <= kAround; ++j) {
      const double around = std::numbers::pi * j / kAround;
      // A shallow furrow runs along the middle of the back.
      const double furrow = j == 0 ? 0.8 * SmoothStep(0, 0.3, t) : 0;
      const double x = j == 0 || j == kAround ? 0 : kWidth(t) * std::sin(around);
      const Vector3d p(x, kMiddleY(t) + kThickness(t) * std::cos(around) - furrow, 81 - 38 * t);
      here.push_back(half.AddVertex(p, color, Part::kTongue, Carrier::kTongue));
    }
    for (int j = 0; j < kAround; ++j)
      half.AddQuad(before[j], before[j + 1], here[j + 1], here[j], Part::kTongue, Region::kTongue);
    before = here;
  }
}

}  // namespace articap::default_head
