// SPDX-License-Identifier: MIT
#include "rig/default_head/ears.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "rig/default_head/curve.h"
#include "rig/default_head/palette.h"

namespace articap::default_head {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kMiddleY = 2;  // of the concha, mm, rig frame
constexpr double kMiddleZ = -13;
constexpr double kSideX = 71.0;  // the head's side there

// A ring of the ear round the concha: how far out in the ear's plane (1 is the outline), and its
// relief, mm off that plane, on the front and the back side.
struct EarRing {
  double radius;
  double relief_mm;
  bool lobe_is_flat;
};
constexpr EarRing kRings[] = {{0.22, -3.6, false}, {0.42, -3.0, false}, {0.55, -0.6, false},
                              {0.66, 1.6, true},   {0.76, 0.2, true},   {0.85, -0.8, true},
                              {0.92, 2.2, true},   {0.985, 3.0, true},  {1.0, 1.0, true},
                              {0.95, -1.8, true},  {0.82, -4.0, true},  {0.6, -12, true}};

// Outline in the ear's plane, mm from the concha, by the angle from backwards over up.
double Outline(double degrees) {
  static const Curve curve{{0, 20},     {30, 25},  {55, 29.5},  {80, 32},  {100, 30}, {122, 24},
                           {150, 15},   {180, 11}, {210, 13},   {240, 24}, {255, 28}, {270, 29.5},
                           {288, 28.5}, {312, 24}, {335, 20.5}, {360, 20}};
  return curve(degrees);
}

Vector3d EarPoint(const EarRing& ring, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const double backward = ring.radius * Outline(degrees) * std::cos(angle);
  const double upward = ring.radius * Outline(degrees) * std::sin(angle);
  const double lobe = Bell((degrees - 275) / 25);
  const double front = Bell((degrees - 185) / 32);
  double relief = ring.relief_mm;
  if (ring.lobe_is_flat && relief > -1) relief *= 1 - 0.75 * lobe;
  // The tragus covers the front of the concha.
  if (ring.radius > 0.5 && ring.radius < 0.97 && relief > -1.5)
    relief += 1.2 * front * Bell((ring.radius - 0.72) / 0.15);
  const double hinge = 0.38 * (backward + 11) * (1 - 0.8 * lobe);
  // The lobe lies on the cheek.
  const double lobe_inward = 3.0 * SmoothStep(-8, -24, upward);
  // The ear leans back by 8 degrees.
  const double lean = 0.14 * upward;
  return {kSideX + hinge + relief + 0.08 * upward - lobe_inward - 1.5 * front,
          kMiddleY + upward + 0.14 * backward, kMiddleZ - backward - lean};
}

}  // namespace

void AddEar(HalfMesh& half) {
  constexpr int kSegments = 24;
  const Vector3f skin = LinearRgb(palette::kSkin);
  const Vector3f blush = LinearRgb(palette::kBlush);
  std::vector<int> inner(
      kSegments, half.AddVertex(EarPoint({0, -3.8, false}, 0), LinearRgb(palette::kMouthInside),
                                Part::kSkin, Carrier::kSkull));
  for (const EarRing& ring : kRings) {
    std::vector<int> outer;
    for (int k = 0; k < kSegments; ++k) {
      const Vector3d p = EarPoint(ring, 360.0 * k / kSegments);
      const double hollow = SmoothStep(1, -8, ring.relief_mm) * (ring.radius < 0.6 ? 1 : 0);
      const Vector3f color = skin + static_cast<float>(0.4 + 0.5 * hollow) * (blush - skin);
      outer.push_back(half.AddVertex(p, color, Part::kSkin, Carrier::kSkull));
    }
    for (int k = 0; k < kSegments; ++k) {
      const int next = (k + 1) % kSegments;
      half.AddQuad(inner[k], outer[k], outer[next], inner[next], Part::kSkin, Region::kSkull);
    }
    inner = outer;
  }
}

}  // namespace articap::default_head
