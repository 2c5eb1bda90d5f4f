// SPDX-License-Identifier: MIT
#include "rig/default_head/contours.h"

#include <cmath>
#include <numbers>

#include "rig/default_head/curve.h"
#include "rig/default_head/face_shape.h"

namespace articap::default_head {
namespace {

// Denser towards the corner.
double Spread(double fraction) { return fraction * (1.18 - 0.18 * fraction); }

}  // namespace

Eigen::Vector2d VermilionBorder(Lip lip, double fraction) {
  // Cupid's bow, then falling to the corner.
  static const Curve upper{{0, -46.1},  {2.5, -45.5}, {5, -44.7},  {8, -45.1},
                           {13, -47.6}, {18, -50.3},  {22, -52.3}, {face::kMouthHalfWidth, -54.2}};
  static const Curve lower{{0, -63.0},
                           {5, -62.8},
                           {10, -61.6},
                           {15, -59.9},
                           {20, -57.5},
                           {23, -55.9},
                           {face::kMouthHalfWidth, -54.2}};
  const double x = face::kMouthHalfWidth * Spread(fraction);
  return {x, lip == Lip::kUpper ? upper(x) : lower(x)};
}

Eigen::Vector2d LidMargin(Lid lid, double fraction) {
  static const Curve upper{{16.2, 12.2}, {18.5, 14.0}, {22, 16.6}, {26, 18.3},
                           {30, 18.9},   {35, 18.5},   {40, 16.9}, {45, 14.4}};
  static const Curve lower{{16.2, 12.2}, {19, 10.9}, {24, 9.4},  {29, 8.6},
                           {34, 8.6},    {39, 9.9},  {43, 12.3}, {45, 14.4}};
  const double smooth = 0.5 - 0.5 * std::cos(std::numbers::pi * fraction);
  const double x = 16.2 + 28.8 * (0.55 * fraction + 0.45 * smooth);
  return {x, lid == Lid::kUpper ? upper(x) : lower(x)};
}

Eigen::Vector3d LipSeam(double fraction) {
  // The upper lip's tubercle hangs in the middle; the line follows the dental arch backwards.
  static const Curve height{{0, -54.3},  {4, -53.6},  {9, -53.2},
                            {14, -53.5}, {20, -54.1}, {24.3, -54.3}};
  static const Curve depth{{0, 98.8}, {6, 98.0}, {12, 95.6}, {18, 91.6}, {24.3, 86.3}};
  const double x = 24.3 * Spread(fraction);
  return {x, height(x), depth(x)};
}

}  // namespace articap::default_head
