// SPDX-License-Identifier: MIT
#include "core/alignment.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <vector>

#include "core/check.h"

namespace articap {
namespace {

using Points = std::span<const Eigen::Vector3d>;
using Weights = std::span<const double>;

double WeightAt(Weights weights, std::size_t i) { return weights.empty() ? 1.0 : weights[i]; }

// Weighted first and second moments of paired points about their centroids.
struct PairMoments {
  double total_weight = 0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  // sum w (target - mean)(source - mean)^T
  double source_scatter = 0;                        // sum w |source - mean|^2
};

PairMoments MomentsOf(Points source, Points target, Weights weights) {
  ARTICAP_CHECK_EQ(source.size(), target.size());
  ARTICAP_CHECK(weights.empty() || weights.size() == source.size());
  PairMoments moments;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double weight = WeightAt(weights, i);
    if (!(weight > 0)) continue;
    moments.total_weight += weight;
    moments.source_mean += weight * source[i];
    moments.target_mean += weight * target[i];
  }
  ARTICAP_CHECK_GT(moments.total_weight, 0);
  moments.source_mean /= moments.total_weight;
  moments.target_mean /= moments.total_weight;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double weight = WeightAt(weights, i);
    if (!(weight > 0)) continue;
    const Eigen::Vector3d from_mean = source[i] - moments.source_mean;
    moments.cross += weight * (target[i] - moments.target_mean) * from_mean.transpose();
    moments.source_scatter += weight * from_mean.squaredNorm();
  }
  return moments;
}

// Weighted moments of one set of points about their centroid; all zero where nothing has weight.
struct Moments {
  int num_points = 0;
  double total_weight = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
};

Moments ScatterOf(Points points, Weights weights) {
  ARTICAP_CHECK(weights.empty() || weights.size() == points.size());
  Moments moments;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = WeightAt(weights, i);
    if (!(weight > 0)) continue;
    ++moments.num_points;
    moments.total_weight += weight;
    moments.mean += weight * points[i];
  }
  if (moments.num_points == 0) return moments;
  moments.mean /= moments.total_weight;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = WeightAt(weights, i);
    if (!(weight > 0)) continue;
    const Eigen::Vector3d from_mean = points[i] - moments.mean;
    moments.scatter += weight * from_mean * from_mean.transpose();
  }
  return moments;
}

template <class Transform>
double WeightedRms(const Transform& target_from_source, Points source, Points target,
                   Weights weights) {
  ARTICAP_CHECK_EQ(source.size(), target.size());
  double sum = 0, total_weight = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double weight = WeightAt(weights, i);
    if (!(weight > 0)) continue;
    sum += weight * (target[i] - target_from_source * source[i]).squaredNorm();
    total_weight += weight;
  }
  return std::sqrt(sum / total_weight);
}

}  // namespace

Eigen::Quaterniond BestRotation(const Eigen::Matrix3d& s) {
  if (!(s.squaredNorm() > 0)) return Eigen::Quaterniond::Identity();
  // Horn (1987), section 4.A: the eigenvector of the largest eigenvalue of N. His S_xy pairs
  // source x with target y, which is s(y, x) here.
  Eigen::Matrix4d n;
  n << s(0, 0) + s(1, 1) + s(2, 2), s(2, 1) - s(1, 2), s(0, 2) - s(2, 0), s(1, 0) - s(0, 1),  //
      s(2, 1) - s(1, 2), s(0, 0) - s(1, 1) - s(2, 2), s(1, 0) + s(0, 1), s(0, 2) + s(2, 0),   //
      s(0, 2) - s(2, 0), s(1, 0) + s(0, 1), s(1, 1) - s(0, 0) - s(2, 2), s(2, 1) + s(1, 2),   //
      s(1, 0) - s(0, 1), s(0, 2) + s(2, 0), s(2, 1) + s(1, 2), s(2, 2) - s(0, 0) - s(1, 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  const double sign = q[0] < 0 ? -1 : 1;  // q and -q are one rotation: keep w positive
  return Eigen::Quaterniond(sign * q[0], sign * q[1], sign * q[2], sign * q[3]).normalized();
}

Rigid3d AlignRigid(Points source, Points target, Weights weights) {
  const PairMoments moments = MomentsOf(source, target, weights);
  const Eigen::Quaterniond rotation = BestRotation(moments.cross);
  return {rotation, moments.target_mean - rotation * moments.source_mean};
}

Sim3d AlignSimilarity(Points source, Points target, Weights weights) {
  const PairMoments moments = MomentsOf(source, target, weights);
  const Eigen::Quaterniond rotation = BestRotation(moments.cross);
  // Umeyama (1991), equation (42): tr(R^T cross) / scatter of the source.
  const double fit = rotation.toRotationMatrix().cwiseProduct(moments.cross).sum();
  const bool has_extent = moments.source_scatter > 0 && fit > 0;
  const double scale = has_extent ? fit / moments.source_scatter : 1.0;
  return {scale, rotation, moments.target_mean - scale * (rotation * moments.source_mean)};
}

double PointSpread::WorstRotationSigma() const {
  const double information = scatter[1] + scatter[2];
  return information > 0 ? 1 / std::sqrt(information) : std::numeric_limits<double>::infinity();
}

double PointSpread::PlacementSigma(const Eigen::Vector3d& point) const {
  // The angles about the principal axes are independent, each with 1 / (sum of the other two
  // scatters); the point moves by angle times its distance from that axis.
  const Eigen::Vector3d arm = axes.transpose() * (point - centroid);
  double variance = 3 / total_weight;
  for (int axis = 0; axis < 3; ++axis) {
    const double distance_squared = arm.squaredNorm() - arm[axis] * arm[axis];
    const double information = scatter.sum() - scatter[axis];
    if (distance_squared > 0) variance += distance_squared / information;
  }
  return std::sqrt(variance);
}

double WorstRotationSigma(Points points, Weights weights) {
  const Moments moments = ScatterOf(points, weights);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.scatter, Eigen::EigenvaluesOnly);
  const double information = solver.eigenvalues()[0] + solver.eigenvalues()[1];
  return information > 0 ? 1 / std::sqrt(information) : std::numeric_limits<double>::infinity();
}

PointSpread SpreadOf(Points points, Weights weights) {
  const Moments moments = ScatterOf(points, weights);
  PointSpread spread;
  spread.num_points = moments.num_points;
  spread.total_weight = moments.total_weight;
  spread.centroid = moments.mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.scatter);
  spread.scatter = solver.eigenvalues().reverse().cwiseMax(0);
  spread.axes = solver.eigenvectors().rowwise().reverse();
  return spread;
}

double AlignmentRms(const Rigid3d& target_from_source, Points source, Points target,
                    Weights weights) {
  return WeightedRms(target_from_source, source, target, weights);
}

double AlignmentRms(const Sim3d& target_from_source, Points source, Points target,
                    Weights weights) {
  return WeightedRms(target_from_source, source, target, weights);
}

ReflectionTest DetectReflection(Points source, Points target, Weights weights, double ratio) {
  std::vector<Eigen::Vector3d> mirrored(source.begin(), source.end());
  for (Eigen::Vector3d& point : mirrored) point.x() = -point.x();
  ReflectionTest test;
  test.rms_proper = AlignmentRms(AlignSimilarity(source, target, weights), source, target, weights);
  test.rms_reflected =
      AlignmentRms(AlignSimilarity(mirrored, target, weights), mirrored, target, weights);
  // Rounding alone must not decide between two fits that are both exact.
  const double rounding = 1e-9 * std::sqrt(SpreadOf(target, weights).scatter.sum());
  test.is_reflected = test.rms_reflected < ratio * test.rms_proper && test.rms_proper > rounding;
  return test;
}

}  // namespace articap
