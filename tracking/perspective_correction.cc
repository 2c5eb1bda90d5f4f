// SPDX-License-Identifier: MIT
#include "tracking/perspective_correction.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace articap {
namespace {

// A dot as it is seen from the middle of the lens: on the plane that touches the unit sphere at it.
struct AngularDot {
  Eigen::Vector3d direction;   // unit, camera frame
  Eigen::Vector3d short_axis;  // unit, across the direction
  double long_radius2 = 0;     // squared radii, rad^2
  double short_radius2 = 0;
};

std::optional<AngularDot> AngularDotOf(const Lens& lens, const Dot& dot) {
  const auto ray = Unproject(lens, dot.center_px);
  if (!ray) return std::nullopt;
  AngularDot result;
  const Eigen::Vector2d plane = ray->hnormalized();
  result.direction = plane.homogeneous().normalized();
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = result.direction.unitOrthogonal();
  across.col(1) = result.direction.cross(across.col(0));
  const Eigen::Matrix2d plane_of_angle =
      (across.topRows<2>() - plane * across.row(2)) / result.direction.z();
  const Eigen::Matrix2d angle_of_px =
      (Eigen::Vector2d(lens.fx_px, lens.fy_px).asDiagonal() *
       DistortJacobian(lens.distortion.data(), plane) * plane_of_angle)
          .inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(angle_of_px * dot.shape_px2 *
                                                            angle_of_px.transpose());
  result.short_radius2 = axes.eigenvalues()[0];
  result.long_radius2 = axes.eigenvalues()[1];
  result.short_axis = across * axes.eigenvectors().col(0);
  if (!(result.short_radius2 > 0) || !std::isfinite(result.long_radius2)) return std::nullopt;
  return result;
}

// Of a marker of radius 1, which is as far as it has to be to appear as large.
constexpr double kDiameter = 2;

std::optional<Eigen::Vector2d> BiasOfSphere(const Lens& lens, const AngularDot& seen) {
  const double radius2 = std::sqrt(seen.long_radius2 * seen.short_radius2);
  return PerspectiveBias(lens, seen.direction / std::sqrt(radius2),
                         {MarkerKind::kSphere, kDiameter, {}});
}

// `side`: 1 or -1, of the two ways in which it may be turned.
std::optional<Eigen::Vector2d> BiasOfDisc(const Lens& lens, const AngularDot& seen, double side) {
  const double cosine2 = seen.short_radius2 / seen.long_radius2;
  const Eigen::Vector3d normal =
      side * std::sqrt(1 - cosine2) * seen.short_axis - std::sqrt(cosine2) * seen.direction;
  return PerspectiveBias(lens, seen.direction / std::sqrt(seen.long_radius2),
                         {MarkerKind::kDisc, kDiameter, normal});
}

}  // namespace

void VisitOptions(PerspectiveOptions& options, OptionVisitor& visit) {
  visit.Enumeration("marker", options.marker, {"disc", "ball"},
                    "what the dots are, for perspective's bias: flat, or balls");
}

double CorrectPerspective(const Lens& lens, const PerspectiveOptions& options, Dot& dot) {
  const auto seen = AngularDotOf(lens, dot);
  if (!seen) return 0;
  const bool is_sphere = options.marker == MarkerKind::kSphere;
  const auto one = is_sphere ? BiasOfSphere(lens, *seen) : BiasOfDisc(lens, *seen, 1);
  const auto other = is_sphere ? one : BiasOfDisc(lens, *seen, -1);
  if (!one || !other) return 0;
  const Eigen::Vector2d mean = (*one + *other) / 2, half_apart = (*one - *other) / 2;
  dot.center_px -= mean;
  dot.covariance_px2 += half_apart * half_apart.transpose();
  return mean.norm();
}

}  // namespace articap
