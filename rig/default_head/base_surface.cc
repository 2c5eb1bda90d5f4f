// SPDX-License-Identifier: MIT
#include "rig/default_head/base_surface.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace articap::default_head {
namespace {

constexpr int kSections = BaseSurface::kNumSections;
constexpr int kLevels = BaseSurface::kNumLevels;

// x, y, z in mm of each section at each level, from the midline of the face to that of the back.
// Breadths at the cheekbones (135), jaw angles (105) and cranium (150), the length of the head
// (190) and the heights of nasion, subnasale and gnathion are those of docs/default-head.md.
// clang-format off
constexpr double kTable[kLevels][kSections][3] = {
    // base of the neck
    {{0, -170, 44}, {25, -170, 38}, {45, -169, 22}, {57, -168, 2},
     {62, -167, -18}, {60, -165, -44}, {38, -162, -72}, {0, -160, -80}},
    {{0, -136, 38}, {20, -136, 35}, {35, -136, 23}, {43.5, -136, 6},
     {48, -135, -12}, {47.5, -132, -36}, {34, -127, -64}, {0, -124, -73}},
    // throat
    {{0, -113, 43}, {19, -113, 40}, {35, -112, 30}, {42, -108, 11},
     {45.5, -105, -8}, {46.5, -102, -34}, {35, -98, -64}, {0, -95, -73}},
    {{0, -104, 67}, {17, -103.5, 63}, {33, -101, 51}, {42.5, -92, 28},
     {47, -81, 4}, {47.5, -76, -26}, {38, -72, -65}, {0, -70, -75}},
    // edge of the jaw: menton, gonion in section 4
    {{0, -98.5, 85}, {17, -97, 79}, {36, -89, 59.5}, {47, -77, 35},
     {52, -63, 10}, {50.5, -55, -22}, {44, -50, -63}, {0, -45, -77}},
    // pogonion
    {{0, -85, 94}, {18, -84, 86.5}, {38, -77, 67}, {50, -66, 40},
     {54.5, -50, 14}, {57, -38, -20}, {51, -30, -63}, {0, -25, -83}},
    // furrow below the lower lip
    {{0, -70, 93.5}, {20, -70, 86.5}, {41, -64, 68}, {54, -53, 42},
     {58.5, -36, 16}, {61, -22, -18}, {57, -12, -62}, {0, -8, -88}},
    // mouth
    {{0, -53, 96.5}, {22, -53, 88}, {43, -50, 70.5}, {57.5, -40, 44},
     {62.5, -24, 18}, {65, -8, -16}, {62, 4, -62}, {0, 8, -92}},
    // subnasale
    {{0, -31, 95}, {22, -31, 86.5}, {44, -31, 71}, {61, -25, 46},
     {66, -12, 19}, {68.5, 4, -15}, {66, 18, -61}, {0, 22, -92.5}},
    // cheekbones
    {{0, -6, 92}, {22, -8, 83}, {44, -8, 72.5}, {62, -6, 48},
     {67.5, 0, 20}, {71, 18, -15}, {70, 32, -60}, {0, 36, -92.5}},
    // eyes
    {{0, 15, 88}, {20, 15, 83}, {40, 15, 77}, {59, 15, 51},
     {67.5, 16, 21}, {73, 30, -15}, {72, 44, -58}, {0, 49, -91.5}},
    // brows
    {{0, 33, 95.5}, {20, 34, 94}, {42, 33, 82.5}, {57, 30, 56},
     {68, 30, 22}, {74.5, 42, -15}, {72.5, 57, -56}, {0, 62, -90}},
    // forehead
    {{0, 55, 95}, {22, 55, 91}, {43, 54, 77.5}, {58, 52, 53},
     {70, 51, 20}, {75, 57, -14}, {70, 71, -52}, {0, 77, -83}},
    {{0, 80, 86}, {22, 80, 82}, {43, 79, 69}, {59.5, 77, 46},
     {70.5, 75, 15}, {72.5, 78, -15}, {62.5, 90, -47}, {0, 96, -69}},
    {{0, 105, 63}, {20, 105, 60}, {38, 104, 49.5}, {53, 103, 33},
     {61.5, 102, 8}, {60.5, 104, -14}, {47, 109, -36}, {0, 114, -49}},
    {{0, 122.5, 32}, {13, 122.5, 30.5}, {24, 122, 25}, {34, 121.5, 15.5},
     {39.5, 121.5, 2}, {37.5, 122.5, -10.5}, {26.5, 124, -22.5}, {0, 125, -27}},
    // crown
    {{0, 130, 2}, {0, 130, 2}, {0, 130, 2}, {0, 130, 2},
     {0, 130, 2}, {0, 130, 2}, {0, 130, 2}, {0, 130, 2}},
};
// clang-format on

Eigen::Vector3d Mirror(const Eigen::Vector3d& point) { return {-point.x(), point.y(), point.z()}; }

// The four weights of a uniform cubic B-spline between control points 1 and 2.
std::array<double, 4> SplineWeights(double u) {
  const double v = 1 - u;
  return {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6,
          u * u * u / 6};
}

// Sweeps of Gauss and Seidel over (c[i-1] + 4 c[i] + c[i+1]) / 6 = p[i]; each halves the error at
// least, so that 40 leave 1e-10 mm.
constexpr int kSweeps = 40;

}  // namespace

BaseSurface::BaseSurface() {
  const auto table = [](int level, int section) {
    return Eigen::Vector3d(kTable[level][section][0], kTable[level][section][1],
                           kTable[level][section][2]);
  };
  // First along the sections: values between which the levels interpolate below.
  std::array<std::array<Eigen::Vector3d, kSections + 2>, kLevels> round;
  for (int level = 0; level < kLevels; ++level) {
    auto& c = round[level];
    for (int i = 0; i < kSections; ++i) c[i + 1] = table(level, i);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (int i = 1; i <= kSections; ++i) {
        c[0] = Mirror(c[2]);
        c[kSections + 1] = Mirror(c[kSections - 1]);
        c[i] = (6 * table(level, i - 1) - c[i - 1] - c[i + 1]) / 4;
      }
      c[1].x() = c[kSections].x() = 0;  // the midlines
    }
    c[0] = Mirror(c[2]);
    c[kSections + 1] = Mirror(c[kSections - 1]);
  }
  for (int section = 0; section < kSections + 2; ++section) {
    for (int i = 0; i < kLevels; ++i) control_[i + 1][section] = round[i][section];
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (int i = 1; i <= kLevels; ++i) {
        control_[0][section] = 2 * control_[1][section] - control_[2][section];
        control_[kLevels + 1][section] =
            2 * control_[kLevels][section] - control_[kLevels - 1][section];
        control_[i][section] =
            (6 * round[i - 1][section] - control_[i - 1][section] - control_[i + 1][section]) / 4;
      }
  }
}

Eigen::Vector3d BaseSurface::At(double section, double level) const {
  const int i = std::clamp(static_cast<int>(section), 0, kSections - 2);
  const int j = std::clamp(static_cast<int>(level), 0, kLevels - 2);
  const std::array<double, 4> across = SplineWeights(section - i);
  const std::array<double, 4> up = SplineWeights(level - j);
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) point += up[b] * across[a] * control_[j + b][i + a];
  return point;
}

Eigen::Vector3d BaseSurface::Outward(double section, double level) const {
  constexpr double kStep = 1e-3;
  // All sections meet at the crown: no normal there.
  const double t = std::min(level, kCrownLevel - 0.1);
  const double s0 = std::max(section - kStep, 0.0), s1 = std::min(section + kStep, kBackSection);
  const Eigen::Vector3d across = At(s1, t) - At(s0, t);
  const Eigen::Vector3d up = At(section, t + kStep) - At(section, t - kStep);
  return across.cross(up).normalized();
}

Eigen::Vector2d BaseSurface::FindInFront(double x_mm, double y_mm) const {
  constexpr double kStep = 1e-4;
  Eigen::Vector2d at(x_mm / 22, 8);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::Vector2d here = At(at).head<2>();
    Eigen::Matrix2d jacobian;
    jacobian.col(0) = (At(at.x() + kStep, at.y()).head<2>() - here) / kStep;
    jacobian.col(1) = (At(at.x(), at.y() + kStep).head<2>() - here) / kStep;
    const Eigen::Vector2d step = jacobian.inverse() * (Eigen::Vector2d(x_mm, y_mm) - here);
    at += step.cwiseMax(-0.7).cwiseMin(0.7);
    at = at.cwiseMax(Eigen::Vector2d(0, 1)).cwiseMin(Eigen::Vector2d(3.6, 14));
    if (step.norm() < 1e-10) break;
  }
  return at;
}

}  // namespace articap::default_head
