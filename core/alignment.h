// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/transforms.h"

namespace articap {

// Closed-form least-squares alignment of paired points:
//   minimise sum_i w_i |target_i - T source_i|^2.
// The rotation is Horn's (1987) unit quaternion, so det R = +1 whatever the data: a reflection is
// never absorbed (DetectReflection says whether one would fit better). Empty weights count as ones.
// Pairs of weight 0 are left out and may be NaN. At least one pair must have a positive weight;
// what the pairs do not determine (see PointSpread) is arbitrary but finite, and for a single pair
// the rotation is the identity.
Rigid3d AlignRigid(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target,
                   std::span<const double> weights = {});

// As above with Umeyama's (1991) scale, which is positive; 1 where the source has no extent.
Sim3d AlignSimilarity(std::span<const Eigen::Vector3d> source,
                      std::span<const Eigen::Vector3d> target,
                      std::span<const double> weights = {});

// The rotation alone, from cross_covariance = sum_i w_i (target_i - mean)(source_i - mean)^T. The
// inner loop of everything above, for callers that keep their own sums.
Eigen::Quaterniond BestRotation(const Eigen::Matrix3d& cross_covariance);

// How far points spread, which is how well they determine a rotation.
struct PointSpread {
  int num_points = 0;       // of positive weight
  double total_weight = 0;  // sum of w_i
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  // sum_i w_i d_i^2 along the principal axes, d_i from the centroid; largest first. The second is
  // near zero for points on a line, the third for points in a plane.
  Eigen::Vector3d scatter = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // its columns are the principal axes

  // Standard deviation of the worst-determined angle, about the first principal axis, of a rigid
  // alignment of points with standard deviations 1/sqrt(w_i) a coordinate, to first order:
  // 1 / sqrt(scatter_2 + scatter_3), radians. Infinite for points on a line.
  double WorstRotationSigma() const;
  // Standard deviation (root of the trace of the covariance) of the place of a point that is moved
  // by that alignment, same unit as the points: least at the centroid, growing with distance.
  double PlacementSigma(const Eigen::Vector3d& point) const;
};
// The same figure without the rest, for inner loops. Empty weights count as ones.
double WorstRotationSigma(std::span<const Eigen::Vector3d> points,
                          std::span<const double> weights = {});
PointSpread SpreadOf(std::span<const Eigen::Vector3d> points, std::span<const double> weights = {});

// Weighted root mean square of |target_i - T source_i|.
double AlignmentRms(const Rigid3d& target_from_source, std::span<const Eigen::Vector3d> source,
                    std::span<const Eigen::Vector3d> target, std::span<const double> weights = {});
double AlignmentRms(const Sim3d& target_from_source, std::span<const Eigen::Vector3d> source,
                    std::span<const Eigen::Vector3d> target, std::span<const double> weights = {});

// Would the mirror image of the source fit the target distinctly better? Then the data are
// mirrored, left-handed, or have left and right named the wrong way round. Points in a plane fit
// both ways equally well and are never called mirrored.
struct ReflectionTest {
  double rms_proper = 0;     // of the best similarity
  double rms_reflected = 0;  // of the best similarity of the mirror image
  bool is_reflected = false;
};
// `ratio`: how much smaller the reflected residual must be to count as distinct.
ReflectionTest DetectReflection(std::span<const Eigen::Vector3d> source,
                                std::span<const Eigen::Vector3d> target,
                                std::span<const double> weights = {}, double ratio = 0.6);

}  // namespace articap
