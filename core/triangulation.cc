// SPDX-License-Identifier: MIT
#include "core/triangulation.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace articap {
namespace {

// The point with the least sum of squared distances to the rays.
std::optional<Eigen::Vector3d> NearestToRays(const CameraArray& array,
                                             const std::vector<Sight>& sights) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  for (const Sight& sight : sights) {
    const auto ray = RayOf(array, sight.view, sight.point_px);
    if (!ray) return std::nullopt;
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - ray->direction * ray->direction.transpose();
    sum += across;
    side += across * ray->origin_mm;
  }
  // Two rays that meet under an angle a give a smallest eigenvalue of 1 - cos a.
  constexpr double kParallel = 1e-9;
  if (!(sum.determinant() > kParallel)) return std::nullopt;
  return sum.ldlt().solve(side);
}

struct Linearized {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double sum_of_squares = 0;
};

std::optional<Linearized> Linearize(const CameraArray& array, const std::vector<Sight>& sights,
                                    const Eigen::Vector3d& point) {
  constexpr double kStep_mm = 1e-3;
  Linearized result;
  for (const Sight& sight : sights) {
    const auto expected = Project(array, sight.view, point);
    if (!expected) return std::nullopt;
    Eigen::Matrix<double, 2, 3> jacobian;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep_mm * Eigen::Vector3d::Unit(axis);
      const auto ahead = Project(array, sight.view, point + step);
      const auto behind = Project(array, sight.view, point - step);
      if (!ahead || !behind) return std::nullopt;
      jacobian.col(axis) = (*ahead - *behind) / (2 * kStep_mm);
    }
    const Eigen::Vector2d residual = sight.point_px - *expected;
    const double weight = 1 / (sight.sigma_px * sight.sigma_px);
    result.normal += weight * jacobian.transpose() * jacobian;
    result.gradient += weight * jacobian.transpose() * residual;
    result.sum_of_squares += residual.squaredNorm();
  }
  return result;
}

}  // namespace

std::optional<StageRay> RayOf(const CameraArray& array, const View& view,
                              const Eigen::Vector2d& point_px) {
  const Camera& camera = array.cameras.at(view.camera);
  const auto in_cam = Unproject(camera.lens, point_px);
  if (!in_cam) return std::nullopt;
  const Rigid3d stage_from_cam = camera.cam_from_stage.Inverse();
  StageRay ray = {stage_from_cam.translation_mm, (stage_from_cam.rotation * *in_cam).normalized()};
  if (view.mirror < 0) return ray;
  const Mirror& mirror = array.mirrors.at(view.mirror);
  const Eigen::Vector3d& normal = mirror.normal_in_stage;
  ray.origin_mm = mirror.Reflect(ray.origin_mm);
  ray.direction -= 2 * normal.dot(ray.direction) * normal;
  return ray;
}

std::optional<TriangulatedPoint> Triangulate(const CameraArray& array,
                                             const std::vector<Sight>& sights) {
  constexpr int kMostSteps = 20;
  constexpr double kStill_mm = 1e-7;
  if (sights.size() < 2) return std::nullopt;
  const auto start = NearestToRays(array, sights);
  if (!start) return std::nullopt;
  TriangulatedPoint result;
  result.point_in_stage_mm = *start;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto linearized = Linearize(array, sights, result.point_in_stage_mm);
    if (!linearized) return std::nullopt;
    const Eigen::LDLT<Eigen::Matrix3d> solver(linearized->normal);
    if (!solver.isPositive()) return std::nullopt;
    const Eigen::Vector3d change = solver.solve(linearized->gradient);
    result.point_in_stage_mm += change;
    result.rms_px = std::sqrt(linearized->sum_of_squares / static_cast<double>(sights.size()));
    result.covariance_mm2 = solver.solve(Eigen::Matrix3d::Identity());
    if (change.norm() < kStill_mm) return result;
  }
  return std::nullopt;
}

}  // namespace articap
