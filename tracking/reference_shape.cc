// SPDX-License-Identifier: MIT
#include "tracking/reference_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/statistics.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Eigen::Vector3d kNowhere = Eigen::Vector3d::Constant(kNaN);

using Points = std::vector<Eigen::Vector3d>;

Points SeenPoints(const StageTracks& tracks, const std::vector<int>& columns, int frame,
                  bool use_filled) {
  Points points;
  for (const int column : columns) {
    const bool is_seen = tracks.state(frame, column) == SampleState::kMeasured || use_filled;
    points.push_back(is_seen ? tracks.position_mm(frame, column) : kNowhere);
  }
  return points;
}

int CountKnown(const Points& points) {
  return static_cast<int>(std::ranges::count_if(
      points, [](const Eigen::Vector3d& point) { return point.allFinite(); }));
}

double DistanceFromMedians(const Points& points, const DistanceStatistics& distances) {
  double sum_mm = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double difference_mm = (points[i] - points[j]).norm() - distances.median_mm(i, j);
      if (!std::isnan(difference_mm)) sum_mm += std::abs(difference_mm);
    }
  return sum_mm;
}

// The frame with the most references; of these the one most like the median of the distances.
Points StartingShape(const StageTracks& tracks, const std::vector<int>& columns,
                     const DistanceStatistics& distances, std::span<const int> frames,
                     bool use_filled) {
  Points best(columns.size(), kNowhere);
  int best_count = 2;
  double best_distance_mm = 0;
  for (const int frame : frames) {
    Points points = SeenPoints(tracks, columns, frame, use_filled);
    const int count = CountKnown(points);
    if (count < std::max(best_count, 3)) continue;
    const double distance_mm = DistanceFromMedians(points, distances);
    if (count == best_count && distance_mm >= best_distance_mm) continue;
    best_count = count;
    best_distance_mm = distance_mm;
    best = std::move(points);
  }
  return best;
}

void Centre(Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) sum += point;
  const int count = CountKnown(points);
  for (Eigen::Vector3d& point : points) point -= sum / std::max(count, 1);
}

// The mean of the aligned frames; references not seen in any of them keep their place.
Points MeanShape(const StageTracks& tracks, FrameAligner& aligner, std::span<const int> frames,
                 bool use_filled) {
  const ReferenceModel& model = aligner.model();
  Points sums(model.columns.size(), Eigen::Vector3d::Zero());
  std::vector<double> weights(model.columns.size(), 0.0);
  for (const int frame : frames) {
    const FrameAlignment alignment = aligner.Align(frame);
    if (alignment.num_used < 3) continue;
    const Eigen::Matrix3d rotation = alignment.shape_from_stage.rotation.toRotationMatrix();
    for (int i = 0; i < model.size(); ++i) {
      const int column = model.columns[i];
      const SampleState state = tracks.state(frame, column);
      if (state == SampleState::kMissing || (state == SampleState::kFilled && !use_filled))
        continue;
      // A reference whose place is not known yet has no robust weight to judge it by.
      const bool is_new = !model.points_mm[i].allFinite();
      const double weight = is_new ? 1.0 : aligner.robust_weights()[i];
      sums[i] += weight * (rotation * tracks.position_mm(frame, column) +
                           alignment.shape_from_stage.translation_mm);
      weights[i] += weight;
    }
  }
  Points mean = model.points_mm;
  for (std::size_t i = 0; i < mean.size(); ++i)
    if (weights[i] > 0) mean[i] = sums[i] / weights[i];
  return mean;
}

// Of the known points; infinite where a point has just become known.
double LargestChange(const Points& before, const Points& after) {
  double largest_mm = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!after[i].allFinite()) continue;
    const double change_mm = (after[i] - before[i]).norm();
    largest_mm = std::isnan(change_mm) ? std::numeric_limits<double>::infinity()
                                       : std::max(largest_mm, change_mm);
  }
  return largest_mm;
}

// The sigmas, but none so small that half of a reference's samples were outliers: where skin moves
// in patches, distances within a patch promise more than the whole keeps.
std::vector<double> SigmasThatCover(FrameAligner& aligner, std::span<const int> frames) {
  constexpr double kMedianOfChi3 = 1.538;  // of the length of a vector of three unit normals
  constexpr int kEnough = 300;
  std::vector<std::vector<double>> residuals_mm(aligner.model().columns.size());
  for (const int pick : SpreadFrames(static_cast<int>(frames.size()), kEnough)) {
    if (aligner.Align(frames[pick]).num_used < 3) continue;
    for (std::size_t i = 0; i < residuals_mm.size(); ++i)
      if (!std::isnan(aligner.residuals_mm()[i]))
        residuals_mm[i].push_back(aligner.residuals_mm()[i]);
  }
  std::vector<double> sigmas_mm = aligner.model().sigmas_mm;
  for (std::size_t i = 0; i < sigmas_mm.size(); ++i)
    if (!residuals_mm[i].empty())
      sigmas_mm[i] = std::max(sigmas_mm[i], MedianOf(std::move(residuals_mm[i])) / kMedianOfChi3);
  return sigmas_mm;
}

}  // namespace

ReferenceModel EstimateReferenceShape(const StageTracks& tracks, const std::vector<int>& columns,
                                      const std::vector<double>& sigmas_mm,
                                      const DistanceStatistics& distances,
                                      std::span<const int> frames, const AlignerOptions& options) {
  constexpr int kMaxIterations = 30;
  constexpr double kSettledMm = 1e-4;
  Points start = StartingShape(tracks, columns, distances, frames, options.use_filled);
  Centre(start);
  FrameAligner aligner(tracks, {columns, std::move(start), sigmas_mm}, options);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Points mean = MeanShape(tracks, aligner, frames, options.use_filled);
    const double change_mm = LargestChange(aligner.model().points_mm, mean);
    aligner.SetPoints(mean);
    if (change_mm < kSettledMm) break;
    if (iteration == 1) aligner.SetSigmas(SigmasThatCover(aligner, frames));
  }
  return aligner.model();
}

std::vector<Eigen::Vector3d> MedianPositions(const StageTracks& tracks, FrameAligner& aligner,
                                             std::span<const int> frames) {
  std::vector<std::array<std::vector<double>, 3>> coordinates(tracks.num_markers());
  for (const int frame : frames) {
    const FrameAlignment alignment = aligner.Align(frame);
    if (alignment.num_used < 3) continue;
    const Eigen::Matrix3d rotation = alignment.shape_from_stage.rotation.toRotationMatrix();
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      if (tracks.state(frame, marker) != SampleState::kMeasured) continue;
      const Eigen::Vector3d point_mm =
          rotation * tracks.position_mm(frame, marker) + alignment.shape_from_stage.translation_mm;
      for (int axis = 0; axis < 3; ++axis) coordinates[marker][axis].push_back(point_mm[axis]);
    }
  }
  Points medians(tracks.num_markers(), kNowhere);
  for (int marker = 0; marker < tracks.num_markers(); ++marker)
    for (int axis = 0; axis < 3; ++axis)
      medians[marker][axis] = MedianOf(std::move(coordinates[marker][axis]));
  return medians;
}

}  // namespace articap
