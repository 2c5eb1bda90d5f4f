// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "rig/default_head/base_surface.h"

namespace articap {

// Places that several parts of the head share, mm, rig frame, on the speaker's left.
namespace face {
inline constexpr double kPupilX = 31.5;  // pupils 63 apart
inline constexpr double kPupilY = 14;
inline constexpr double kEyeZ = 70.0;  // centre of the eyeball
inline constexpr double kEyeRadius = 13.2;
inline constexpr double kLidRadius = 14.6;  // outer surface of the lids over the eyeball
inline constexpr double kMouthHalfWidth = 25.5;
inline constexpr double kStomionY = -53.8;
}  // namespace face

// The skin: the base surface with the relief of nose, orbits, cheeks, lips' surroundings, chin and
// hair. The vermilion, the lids' margins and what lies behind them are made by their own parts.
class FaceShape {
 public:
  // Point of the skin at a section and level of the base surface, mm, rig frame.
  Eigen::Vector3d At(const Eigen::Vector2d& section_level) const;
  // The skin as a view from the front shows it at x, y.
  Eigen::Vector3d InFront(double x_mm, double y_mm) const;

  // How far the nose stands out of the face there, mm.
  double NoseRelief(const Eigen::Vector2d& section_level) const;

  // Level where the hair begins at a section.
  static double Hairline(double section);
  // 1 under the hair, 0 outside.
  static double HairCover(const Eigen::Vector2d& section_level);

  const BaseSurface& base() const { return base_; }

 private:
  // Depth z of the face without nose and lids, mm.
  double Ground(double section, const Eigen::Vector3d& on_base) const;

  BaseSurface base_;
};

}  // namespace articap
