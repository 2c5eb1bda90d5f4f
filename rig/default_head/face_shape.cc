// SPDX-License-Identifier: MIT
#include "rig/default_head/face_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rig/default_head/curve.h"

namespace articap::default_head {
namespace {

double Bell2(double x, double y) { return Bell(x) * Bell(y); }

// Distance to the segment a b, and where along it (0 to 1) the nearest point lies.
struct SegmentDistance {
  double distance;
  double along;
};
SegmentDistance ToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                          const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double along = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return {(p - a - along * ab).norm(), along};
}

// Relief of forehead, orbits and cheeks: mm forward of the base surface. x is not negative.
double FaceRelief(double x, double y) {
  double z = 0;
  // orbit: beside the root of the nose, below the brow, at the outer corner
  z -= 5.0 * Bell2((x - 17) / 5.5, (y - 14) / 8);
  z -= 3.0 * Bell2((x - 31) / 12, (y - 23.5) / 4.0);
  z -= 2.5 * Bell2((x - 48) / 5, (y - 13) / 8);
  // brow ridge and glabella
  z += 2.2 * Bell2((x - 26) / 13, (y - 32.5) / 5);
  // cheekbone, fullness of the cheek
  z += 2.6 * Bell2((x - 45) / 10, (y + 9) / 9);
  z += 1.6 * Bell2((x - 33) / 8, (y + 26) / 11);
  // hollow below the cheekbone
  z -= 1.5 * Bell2((x - 47) / 8, (y + 38) / 9);
  // from the inner corner of the eye down and out
  const Eigen::Vector2d p(x, y);
  const SegmentDistance trough = ToSegment(p, {18, 5}, {38, -4});
  z -= 1.2 * Bell(trough.distance / 3.5);
  // nasolabial furrow
  const SegmentDistance furrow = ToSegment(p, {20, -22}, {33, -52});
  z -= 1.7 * Bell(furrow.distance / 2.8) * SmoothStep(1.15, 0.2, furrow.along);
  return z;
}

// Relief round the mouth: mm forward of the base surface.
double MouthRelief(double x, double y) {
  double z = 0;
  z += 4.2 * Bell2(x / 16, (y + 52) / 11);
  // philtrum between its two ridges
  z -= 1.7 * Bell2(x / 2.5, (y + 38.5) / 5.5);
  z += 0.9 * Bell2((x - 5.2) / 2.2, (y + 39) / 6);
  // corner of the mouth
  z -= 1.4 * Bell2((x - 28.5) / 3.0, (y + 55) / 4.5);
  // furrow between lower lip and chin, chin
  z -= 1.3 * Bell2(x / 14, (y + 70.5) / 4.0);
  z += 2.0 * Bell2(x / 12, (y + 84) / 7.5);
  return z;
}

// The nose as a roof along its bridge, with tip and wings: absolute z in mm.
double NoseHeight(double x, double y, double ground) {
  static const Curve bridge{{-36, 70},    {-33, 83},    {-31, 92.5},  {-29.3, 99},  {-27.5, 105.5},
                            {-25, 111.8}, {-22, 114.6}, {-19, 115.4}, {-16, 114.6}, {-10, 110.6},
                            {-4, 107},    {2, 102.8},   {8, 98.6},    {14, 95.2},   {20, 93.6},
                            {26, 94.6},   {33, 96.4},   {40, 92}};
  static const Curve steepness{{-34, 3.0}, {-26, 2.6}, {-22, 2.0}, {-10, 1.75},
                               {6, 1.5},   {20, 1.1},  {34, 0.5}};
  static const Curve roundness{{-30, 2.0}, {-24, 4.0}, {-19, 5.5}, {-12, 4.2},
                               {0, 3.4},   {20, 4.5},  {34, 8}};
  const double e = roundness(y);
  double z = bridge(y) - steepness(y) * (std::sqrt(x * x + e * e) - e);
  const double tip =
      115.4 - 5.0 * (std::pow(x / 7.5, 2) + std::pow((y + 19.5) / (y < -19.5 ? 4.8 : 7.0), 2));
  z = SmoothMax(z, tip, 2.5);
  const double wing_x = (x - 12.3) / 5.8;
  const double wing_y = (y + 22.3) / 6.2;
  const double wing = 106.5 - 0.25 * (x - 12.3) - 9.0 * (wing_x * wing_x + wing_y * wing_y);
  z = SmoothMax(z, wing, 2.5);
  return SmoothMax(ground, z, 2.0 + 6.0 * SmoothStep(-8, 20, y));
}

// The lids lie on the eyeball like a larger ball; z in mm.
double LidHeight(double x, double y, double ground) {
  const double dx = x - face::kPupilX;
  const double dy = y - face::kPupilY;
  const double reach = face::kLidRadius * face::kLidRadius - dx * dx - dy * dy;
  // Beyond the ball's outline the parabola that touches it goes on.
  const double ball = face::kEyeZ + (reach > 16 ? std::sqrt(reach) : 2 + reach / 8);
  double z = SmoothMax(ground, ball, 3.0);
  // crease above the upper lid
  const double crease_y = 23.2 - 0.016 * (dx - 1) * (dx - 1);
  z -= 1.3 * Bell((y - crease_y) / 1.3) * Bell(dx / 9.5);
  return z;
}

bool IsOnFace(double section, const Eigen::Vector3d& on_base) {
  return section < 3.6 && on_base.y() < 75 && on_base.y() > -110;
}

bool IsNearNose(const Eigen::Vector3d& on_base) {
  return on_base.x() < 40 && on_base.y() < 45 && on_base.y() > -40;
}

}  // namespace

double FaceShape::Hairline(double section) {
  static const Curve line{{0, 12.95},  {1, 13.0},   {1.8, 12.9},  {2.4, 12.5},  {2.85, 11.8},
                          {3.1, 11.1}, {3.3, 10.4}, {3.45, 9.5},  {3.6, 9.0},   {3.8, 8.85},
                          {4.0, 9.1},  {4.2, 9.9},  {4.45, 10.4}, {4.75, 10.2}, {5.0, 8.9},
                          {5.2, 7.2},  {5.45, 6.0}, {6, 5.2},     {7, 4.9}};
  return line(section);
}

double FaceShape::HairCover(const Eigen::Vector2d& section_level) {
  const double line = Hairline(section_level.x());
  return SmoothStep(line + 0.4, line + 0.9, section_level.y());
}

double FaceShape::Ground(double section, const Eigen::Vector3d& on_base) const {
  // The relief belongs to what faces forward.
  const double facing = SmoothStep(3.6, 2.6, section);
  const double x = on_base.x(), y = on_base.y();
  return on_base.z() + facing * (FaceRelief(x, y) + MouthRelief(x, y));
}

double FaceShape::NoseRelief(const Eigen::Vector2d& section_level) const {
  const Eigen::Vector3d point = base_.At(section_level);
  if (!IsOnFace(section_level.x(), point) || !IsNearNose(point)) return 0;
  const double ground = Ground(section_level.x(), point);
  return NoseHeight(point.x(), point.y(), ground) - ground;
}

Eigen::Vector3d FaceShape::At(const Eigen::Vector2d& section_level) const {
  Eigen::Vector3d point = base_.At(section_level);
  if (IsOnFace(section_level.x(), point)) {
    const double x = point.x(), y = point.y();
    double z = Ground(section_level.x(), point);
    if (IsNearNose(point)) z = NoseHeight(x, y, z);
    if (x < 56 && y < 40 && y > -12) z = LidHeight(x, y, z);
    point.z() = z;
    // The nostrils open into the underside of the nose.
    const double nostril = Bell2((x - 6.3) / 2.3, (y + 27.6) / 1.9);
    point += nostril * Eigen::Vector3d(0, 3.0, -4.0);
  }
  // Under the hair the scalp keeps clear of the cap.
  const double hair = HairCover(section_level);
  if (hair > 0) point -= 2.5 * hair * base_.Outward(section_level.x(), section_level.y());
  return point;
}

Eigen::Vector3d FaceShape::InFront(double x_mm, double y_mm) const {
  return At(base_.FindInFront(x_mm, y_mm));
}

}  // namespace articap::default_head
