// SPDX-License-Identifier: MIT
#include "tracking/pose_estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace articap {
namespace {

// Of a point whose file does not say how well it was measured.
constexpr double kAssumedPointSigma_mm = 0.2;

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;

// Of a place by a PoseChange.
Matrix36d DerivativeAt(const Eigen::Vector3d& place_mm, const Eigen::Vector3d& center_mm) {
  const Eigen::Vector3d arm = place_mm - center_mm;
  Matrix36d derivative = Matrix36d::Zero();
  derivative.leftCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  derivative.rightCols<3>().setIdentity();
  return derivative;
}

}  // namespace

PoseEstimate PoseEstimate::Isotropic(const Rigid3d& template_from_stage,
                                     const Eigen::Vector3d& center_mm, double rotation_sigma_rad,
                                     double translation_sigma_mm) {
  PoseEstimate estimate = {template_from_stage, center_mm, Matrix6d::Zero()};
  estimate.covariance.diagonal().head<3>().setConstant(rotation_sigma_rad * rotation_sigma_rad);
  estimate.covariance.diagonal().tail<3>().setConstant(translation_sigma_mm * translation_sigma_mm);
  return estimate;
}

Eigen::Matrix3d PoseEstimate::CovarianceAt_mm2(const Eigen::Vector3d& place_mm) const {
  const Matrix36d derivative = DerivativeAt(place_mm, center_mm);
  return derivative * covariance * derivative.transpose();
}

Rigid3d Changed(const Rigid3d& pose, const Eigen::Vector3d& center_mm, const PoseChange& change) {
  const Eigen::Vector3d turn = change.head<3>();
  const double angle = turn.norm();
  Rigid3d between;
  if (angle > 0) between.rotation = Eigen::AngleAxisd(angle, turn / angle);
  between.translation_mm = center_mm + change.tail<3>() - between.rotation * center_mm;
  return between * pose;
}

PoseChange ChangeBetween(const Rigid3d& from, const Rigid3d& to, const Eigen::Vector3d& center_mm) {
  const Rigid3d between = to * from.Inverse();
  const Eigen::AngleAxisd turn(between.rotation);
  PoseChange change;
  change << turn.angle() * turn.axis(), between * center_mm - center_mm;
  return change;
}

Eigen::Vector3d MiddleOf(std::span<const MarkerPlace> markers) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const MarkerPlace& marker : markers) sum += marker.position_mm;
  return sum / static_cast<double>(markers.size());
}

Eigen::Matrix3d CovarianceOf_mm2(const CloudPoint& point) {
  if (point.covariance_mm2.allFinite()) return point.covariance_mm2;
  return kAssumedPointSigma_mm * kAssumedPointSigma_mm * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d CovarianceInTemplate_mm2(const CloudPoint& point,
                                         const Rigid3d& template_from_stage) {
  const Eigen::Matrix3d rotation = template_from_stage.rotation.toRotationMatrix();
  return rotation * CovarianceOf_mm2(point) * rotation.transpose();
}

PoseEstimate PoseOf(std::span<const MarkerPlace> markers, std::span<const CloudPoint> cloud,
                    const std::vector<int>& points, const PoseEstimate& prior) {
  constexpr int kMostSteps = 8;
  constexpr double kStill = 1e-7;  // rad, and mm
  const Matrix6d information = prior.covariance.llt().solve(Matrix6d::Identity());
  PoseEstimate pose = prior;
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix6d normal = information;
    PoseChange side = -information * ChangeBetween(prior.template_from_stage,
                                                   pose.template_from_stage, prior.center_mm);
    for (int m = 0; m < static_cast<int>(points.size()); ++m) {
      if (points[m] < 0) continue;
      const CloudPoint& point = cloud[points[m]];
      const Eigen::Vector3d place = pose.template_from_stage * point.position_in_stage_mm;
      const Eigen::Matrix3d covariance =
          CovarianceInTemplate_mm2(point, pose.template_from_stage) + markers[m].covariance_mm2;
      const Matrix36d derivative = DerivativeAt(place, prior.center_mm);
      const Eigen::Matrix<double, 6, 3> weighted =
          derivative.transpose() * covariance.llt().solve(Eigen::Matrix3d::Identity());
      normal += weighted * derivative;
      side += weighted * (markers[m].position_mm - place);
    }
    const Eigen::LDLT<Matrix6d> factor(normal);
    const PoseChange change = factor.solve(side);
    pose.template_from_stage = Changed(pose.template_from_stage, prior.center_mm, change);
    pose.covariance = factor.solve(Matrix6d::Identity());
    if (change.norm() < kStill) break;
  }
  return pose;
}

}  // namespace articap
