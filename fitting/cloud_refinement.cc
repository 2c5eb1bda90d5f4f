// SPDX-License-Identifier: MIT
#include "fitting/cloud_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>

namespace articap {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

constexpr int kMaxIterations = 60;
// Below this relative decrease of the cost, steps no longer matter to a proposal.
constexpr double kLeastDecrease = 1e-5;

// A similarity near another: turned by `step[0..2]` rad about `center`, moved by `step[3..5]` mm,
// scaled about `center` by exp(step[6]).
Sim3d Perturbed(const Sim3d& transform, const Vector7d& step, const Eigen::Vector3d& center) {
  const double angle = step.head<3>().norm();
  const Eigen::Quaterniond turn =
      angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, step.head<3>() / angle))
                : Eigen::Quaterniond::Identity();
  Sim3d about_center{std::exp(step[6]), turn, Eigen::Vector3d::Zero()};
  about_center.translation_mm = center + step.segment<3>(3) - about_center * center;
  return about_center * transform;
}

// The reweighted normal equations at one transform.
struct Linearized {
  double cost = 0;
  Matrix7d hessian = Matrix7d::Zero();
  Vector7d gradient = Vector7d::Zero();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
};

class CloudProblem {
 public:
  CloudProblem(const FaceSurface& surface, std::span<const Eigen::Vector3d> cloud_mm,
               const CloudModel& model, bool at_landmarks)
      : surface_(surface), cloud_mm_(cloud_mm), model_(model), at_landmarks_(at_landmarks) {}

  Linearized At(const Sim3d& rig_from_cloud) const {
    Linearized result;
    for (const Eigen::Vector3d& point : cloud_mm_)
      result.center += rig_from_cloud * point / static_cast<double>(cloud_mm_.size());
    for (const Eigen::Vector3d& point : cloud_mm_) {
      const Eigen::Vector3d moved = rig_from_cloud * point;
      AddSurface(moved, result);
      if (at_landmarks_) AddLandmark(moved, result);
    }
    const double log_scale = std::log(rig_from_cloud.scale);
    const double weight = 1 / (model_.scale_sd * model_.scale_sd);
    result.cost += weight * log_scale * log_scale;
    result.gradient[6] += weight * log_scale;
    result.hessian(6, 6) += weight;
    return result;
  }

 private:
  // d(direction . moved) / d(step).
  static Vector7d Derivative(const Eigen::Vector3d& direction, const Eigen::Vector3d& arm) {
    Vector7d derivative;
    derivative << arm.cross(direction), direction, direction.dot(arm);
    return derivative;
  }

  void AddSurface(const Eigen::Vector3d& moved, Linearized& result) const {
    const FaceSurface::Foot foot = surface_.Nearest(moved);
    const double variance = model_.surface_sd_mm * model_.surface_sd_mm;
    const double squared = foot.distance_mm * foot.distance_mm;
    result.cost += std::log1p(squared / variance);
    // Beyond the rim of the surface the way to the foot is not along the normal.
    constexpr double kOnSurface_mm = 1e-6;
    const Eigen::Vector3d direction = foot.distance_mm > kOnSurface_mm
                                          ? Eigen::Vector3d((moved - foot.point) / foot.distance_mm)
                                          : foot.normal;
    AddSquare(Derivative(direction, moved - result.center), foot.distance_mm,
              1 / (variance + squared), result);
  }

  void AddLandmark(const Eigen::Vector3d& moved, Linearized& result) const {
    double squared = std::numeric_limits<double>::infinity();
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    for (const FaceSurface::NamedPlace& place : surface_.places()) {
      const Eigen::Vector3d candidate = moved - place.point_in_rig;
      if (candidate.squaredNorm() >= squared) continue;
      squared = candidate.squaredNorm();
      offset = candidate;
    }
    if (!std::isfinite(squared)) return;
    const double variance = model_.landmark_sd_mm * model_.landmark_sd_mm;
    result.cost += std::log1p(squared / variance);
    for (int axis = 0; axis < 3; ++axis)
      AddSquare(Derivative(Eigen::Vector3d::Unit(axis), moved - result.center), offset[axis],
                1 / (variance + squared), result);
  }

  static void AddSquare(const Vector7d& derivative, double residual, double weight,
                        Linearized& result) {
    result.hessian += weight * derivative * derivative.transpose();
    result.gradient += weight * residual * derivative;
  }

  const FaceSurface& surface_;
  std::span<const Eigen::Vector3d> cloud_mm_;
  const CloudModel& model_;
  bool at_landmarks_;
};

}  // namespace

CloudFit RefineCloudAlignment(const FaceSurface& surface, std::span<const Eigen::Vector3d> cloud_mm,
                              const Sim3d& start, const CloudModel& model, bool at_landmarks) {
  const CloudProblem problem(surface, cloud_mm, model, at_landmarks);
  Sim3d best = start;
  Linearized here = problem.At(best);
  double damping = 1e-3;
  for (int iteration = 0; iteration < kMaxIterations && damping < 1e6; ++iteration) {
    Matrix7d damped = here.hessian;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12;
    const Vector7d step = -damped.ldlt().solve(here.gradient);
    const Sim3d candidate = Perturbed(best, step, here.center);
    Linearized there = problem.At(candidate);
    if (!(there.cost < here.cost)) {
      damping *= 10;
      continue;
    }
    const bool settled = here.cost - there.cost < kLeastDecrease * here.cost;
    best = candidate;
    here = std::move(there);
    damping = std::max(damping / 10, 1e-9);
    if (settled) break;
  }
  return {best, here.cost};
}

}  // namespace articap
