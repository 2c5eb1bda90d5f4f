// SPDX-License-Identifier: MIT
#include "tracking/label_assignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/alignment.h"
#include "tracking/assignment.h"

namespace articap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Beyond this many standard deviations a point is no candidate, whatever else there is.
constexpr double kFarthest_sigmas = 8;
// Of a point whose file does not say how well it was measured.
constexpr double kAssumedPointSigma_mm = 0.2;

Eigen::Matrix3d CovarianceOf_mm2(const CloudPoint& point) {
  if (point.covariance_mm2.allFinite()) return point.covariance_mm2;
  return kAssumedPointSigma_mm * kAssumedPointSigma_mm * Eigen::Matrix3d::Identity();
}

// Of two labelled points that claim one dot, the dearer: marker index, or -1.
int FindContradiction(const LabelCosts& costs, std::span<const CloudPoint> cloud,
                      const std::vector<int>& points) {
  const int num_markers = static_cast<int>(points.size());
  for (int first = 0; first < num_markers; ++first) {
    if (points[first] < 0) continue;
    for (int second = first + 1; second < num_markers; ++second)
      if (points[second] >= 0 && ClaimOneDot(cloud[points[first]], cloud[points[second]]))
        return costs.costs(first, points[first]) > costs.costs(second, points[second]) ? first
                                                                                       : second;
  }
  return -1;
}

}  // namespace

bool ClaimOneDot(const CloudPoint& a, const CloudPoint& b) {
  for (const DotSight& sight : a.sights)
    for (const DotSight& other : b.sights)
      if (sight.view.camera == other.view.camera && sight.dot == other.dot) return true;
  return false;
}

LabelCosts CostsOf(std::span<const Expectation> markers, std::span<const CloudPoint> cloud,
                   const Rigid3d& template_from_stage, double pose_sigma_mm,
                   const LabelOptions& options) {
  const double false_per_mm3 = std::max(options.false_points, 1e-3) / std::pow(300.0, 3);
  const double constant =
      3 * std::log(2 * std::numbers::pi) + 2 * std::log(false_per_mm3) - 2 * std::log(options.seen);
  LabelCosts result;
  result.null_cost = -2 * std::log(1 - options.seen);
  result.costs.setConstant(static_cast<int>(markers.size()), static_cast<int>(cloud.size()),
                           kInfinity);
  const Eigen::Matrix3d rotation = template_from_stage.rotation.toRotationMatrix();
  for (int p = 0; p < static_cast<int>(cloud.size()); ++p) {
    const Eigen::Vector3d position =
        rotation * cloud[p].position_in_stage_mm + template_from_stage.translation_mm;
    const Eigen::Matrix3d covariance = rotation * CovarianceOf_mm2(cloud[p]) * rotation.transpose();
    const double largest = covariance.trace();
    for (int m = 0; m < static_cast<int>(markers.size()); ++m) {
      const Eigen::Vector3d apart = position - markers[m].position_mm;
      const double variance =
          markers[m].sigma_mm * markers[m].sigma_mm + pose_sigma_mm * pose_sigma_mm;
      if (apart.squaredNorm() > kFarthest_sigmas * kFarthest_sigmas * (variance + largest))
        continue;
      const Eigen::LLT<Eigen::Matrix3d> factor(covariance + variance * Eigen::Matrix3d::Identity());
      const double log_determinant =
          2 * Eigen::Matrix3d(factor.matrixL()).diagonal().array().log().sum();
      result.costs(m, p) = factor.matrixL().solve(apart).squaredNorm() + log_determinant + constant;
    }
  }
  return result;
}

std::vector<int> AssignPoints(const LabelCosts& costs, std::span<const CloudPoint> cloud) {
  LabelCosts allowed = costs;
  while (true) {
    std::vector<int> points = Assign(allowed.costs, allowed.null_cost);
    const int refused = FindContradiction(allowed, cloud, points);
    if (refused < 0) return points;
    allowed.costs(refused, points[refused]) = kInfinity;
  }
}

double TotalCost(const LabelCosts& costs, const std::vector<int>& points) {
  double total = 0;
  for (int m = 0; m < static_cast<int>(points.size()); ++m)
    total += points[m] < 0 ? costs.null_cost : costs.costs(m, points[m]);
  return total;
}

std::vector<float> MarginsOf(const LabelCosts& costs, const std::vector<int>& points) {
  std::vector<char> taken(static_cast<std::size_t>(costs.costs.cols()), 0);
  for (const int point : points)
    if (point >= 0) taken[point] = 1;
  std::vector<float> margins(points.size(), std::numeric_limits<float>::quiet_NaN());
  for (int m = 0; m < static_cast<int>(points.size()); ++m) {
    if (points[m] < 0) continue;
    const double own = costs.costs(m, points[m]);
    double least = costs.null_cost - own;
    for (int p = 0; p < costs.costs.cols(); ++p)
      if (!taken[p]) least = std::min(least, costs.costs(m, p) - own);
    for (int other = 0; other < static_cast<int>(points.size()); ++other) {
      if (other == m) continue;
      const double before = points[other] < 0 ? costs.null_cost : costs.costs(other, points[other]);
      const double after = costs.costs(other, points[m]) +
                           (points[other] < 0 ? costs.null_cost : costs.costs(m, points[other]));
      least = std::min(least, after - before - own);
    }
    margins[m] = static_cast<float>(least / 2);
  }
  return margins;
}

std::optional<Rigid3d> PoseOf(std::span<const Expectation> markers,
                              std::span<const CloudPoint> cloud, const std::vector<int>& points) {
  std::vector<Eigen::Vector3d> source, target;
  std::vector<double> weights;
  for (int m = 0; m < static_cast<int>(points.size()); ++m) {
    if (points[m] < 0) continue;
    const CloudPoint& point = cloud[points[m]];
    source.push_back(point.position_in_stage_mm);
    target.push_back(markers[m].position_mm);
    weights.push_back(
        1 / (markers[m].sigma_mm * markers[m].sigma_mm + CovarianceOf_mm2(point).trace() / 3));
  }
  constexpr double kMostUncertain_rad = 0.5;
  if (source.size() < 3 || !(WorstRotationSigma(target, weights) < kMostUncertain_rad))
    return std::nullopt;
  return AlignRigid(source, target, weights);
}

}  // namespace articap
