// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>

namespace articap {

// The head without nose, lips, lids, ears and hair: a smooth surface through a table of points that
// follow the anthropometry of an average adult. Sections s run round the left half, from 0, the
// midline of the face, to 7, the midline of the back; levels t run from 0, the base of the neck, over
// 4, the edge of the jaw from chin to ear, to 16, the crown.
class BaseSurface {
 public:
  static constexpr int kNumSections = 8;
  static constexpr int kNumLevels = 17;
  static constexpr double kBackSection = kNumSections - 1;
  static constexpr double kCrownLevel = kNumLevels - 1;

  BaseSurface();

  // The point of the surface, mm, rig frame.
  Eigen::Vector3d At(double section, double level) const;
  Eigen::Vector3d At(const Eigen::Vector2d& section_level) const {
    return At(section_level.x(), section_level.y());
  }

  // Unit normal of the surface, outwards.
  Eigen::Vector3d Outward(double section, double level) const;

  // Section and level of the point of the face (not of the back) that a view from the front shows at
  // x, y.
  Eigen::Vector2d FindInFront(double x_mm, double y_mm) const;

 private:
  // Control points of a bicubic B-spline, with one more section and level at each end.
  std::array<std::array<Eigen::Vector3d, kNumSections + 2>, kNumLevels + 2> control_;
};

}  // namespace articap
