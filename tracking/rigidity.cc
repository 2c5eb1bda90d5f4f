// SPDX-License-Identifier: MIT
#include "tracking/rigidity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/statistics.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Marker after marker, frame after frame; NaN where not usable.
std::vector<Eigen::Vector3d> CopyPositions(const StageTracks& tracks, std::span<const int> columns,
                                           std::span<const int> frames, bool use_filled) {
  std::vector<Eigen::Vector3d> positions_mm;
  positions_mm.reserve(columns.size() * frames.size());
  for (const int column : columns)
    for (const int frame : frames) {
      const bool is_seen = tracks.state(frame, column) == SampleState::kMeasured || use_filled;
      positions_mm.push_back(is_seen ? tracks.position_mm(frame, column)
                                     : Eigen::Vector3d::Constant(kNaN));
    }
  return positions_mm;
}

}  // namespace

std::vector<int> SpreadFrames(int num_frames, int max_frames) {
  ARTICAP_CHECK_GT(max_frames, 1);
  std::vector<int> frames;
  if (num_frames <= max_frames) {
    for (int frame = 0; frame < num_frames; ++frame) frames.push_back(frame);
    return frames;
  }
  for (std::int64_t i = 0; i < max_frames; ++i)
    frames.push_back(static_cast<int>(i * (num_frames - 1) / (max_frames - 1)));
  return frames;
}

DistanceStatistics MeasureDistances(const StageTracks& tracks, std::span<const int> columns,
                                    std::span<const int> frames, bool use_filled) {
  const auto size = static_cast<Eigen::Index>(columns.size());
  const auto positions_mm = CopyPositions(tracks, columns, frames, use_filled);
  DistanceStatistics statistics;
  statistics.median_mm = Eigen::MatrixXd::Constant(size, size, kNaN);
  statistics.variance_mm2 = Eigen::MatrixXd::Constant(size, size, kNaN);
  statistics.num_frames = Eigen::MatrixXi::Zero(size, size);
  std::vector<double> distances_mm;
  distances_mm.reserve(frames.size());
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      distances_mm.clear();
      const Eigen::Vector3d* const a = positions_mm.data() + i * std::ssize(frames);
      const Eigen::Vector3d* const b = positions_mm.data() + j * std::ssize(frames);
      for (std::size_t k = 0; k < frames.size(); ++k)
        if (const double distance_mm = (a[k] - b[k]).norm(); !std::isnan(distance_mm))
          distances_mm.push_back(distance_mm);
      const int count = static_cast<int>(distances_mm.size());
      statistics.num_frames(i, j) = statistics.num_frames(j, i) = count;
      if (count == 0) continue;
      const double median_mm = MedianOf(distances_mm);
      statistics.median_mm(i, j) = statistics.median_mm(j, i) = median_mm;
      if (count < kMinFramesForVariance) continue;
      const double range_mm = QuantileOf(distances_mm, 0.9) - QuantileOf(distances_mm, 0.1);
      const double sigma_mm = range_mm / kSigmasFrom10To90Percent;
      statistics.variance_mm2(i, j) = statistics.variance_mm2(j, i) = sigma_mm * sigma_mm;
    }
  return statistics;
}

std::vector<double> SigmasOfMembers(const Eigen::MatrixXd& variance_mm2,
                                    std::span<const int> members) {
  const auto size = static_cast<Eigen::Index>(members.size());
  // Normal equations of var(i, j) = x_i + x_j over the pairs with a variance. All pairs weigh the
  // same: by their precision (1/variance^2) they would pay off on independent noise, but pairs that
  // sit on one piece of skin would then decide everything.
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j) {
      if (i == j) continue;
      const double variance = variance_mm2(members[i], members[j]);
      if (std::isnan(variance)) continue;
      normal(i, i) += 1;
      normal(i, j) += 1;
      right[i] += variance;
    }
  // Too few pairs leave the system singular; the slight pull to the assumed variance decides then.
  constexpr double kPull = 1e-6;
  normal.diagonal().array() += kPull;
  right.array() += kPull * kAssumedSigmaMm * kAssumedSigmaMm;
  const Eigen::VectorXd variances = normal.ldlt().solve(right);

  std::vector<double> sigmas_mm;
  // Estimates of good markers among bad ones may come out below zero; no member is called better
  // than a fifth of the whole.
  const double mean_mm2 = std::max(variances.mean(), 0.0);
  const double least_mm2 = std::max(kSmallestSigmaMm * kSmallestSigmaMm, mean_mm2 / 25);
  for (Eigen::Index i = 0; i < size; ++i)
    sigmas_mm.push_back(std::sqrt(std::max(variances[i], least_mm2)));
  return sigmas_mm;
}

std::vector<double> WeightingSigmas(std::vector<double> sigmas_mm) {
  const double median_mm = MedianOf(sigmas_mm);
  for (double& sigma_mm : sigmas_mm) sigma_mm = std::max(sigma_mm, median_mm);
  return sigmas_mm;
}

}  // namespace articap
