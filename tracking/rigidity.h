// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/tracks.h"

namespace articap {

// At most `max_frames` frames, evenly spread over a take of `num_frames`, first and last included.
std::vector<int> SpreadFrames(int num_frames, int max_frames);

// Distances between markers do not depend on where the head is: how much they vary says which
// markers are rigid, before any pose is known.
struct DistanceStatistics {
  Eigen::MatrixXd median_mm;     // NaN where a pair is never seen together
  Eigen::MatrixXd variance_mm2;  // robust; NaN where a pair is seen together in too few frames
  Eigen::MatrixXi num_frames;    // in which both are seen
};

// Of the markers in `columns`, over `frames`. The variance is that of a normal distribution with
// the same distance from the 10th to the 90th percentile: one sample in five may be an outlier, yet
// movement during a fifth of the take is noticed.
DistanceStatistics MeasureDistances(const StageTracks& tracks, std::span<const int> columns,
                                    std::span<const int> frames, bool use_filled);

inline constexpr double kSigmasFrom10To90Percent = 2.5631;

// Fewer frames than this say nothing about a variance.
inline constexpr int kMinFramesForVariance = 20;
// What is then assumed of a marker: mm, a coordinate, typical of optical systems and skin over
// bone.
inline constexpr double kAssumedSigmaMm = 0.3;
// No marker is trusted to be better than this: mm, a coordinate.
inline constexpr double kSmallestSigmaMm = 0.01;

// The standard deviation of each member, mm a coordinate, that best explains the variances of their
// distances, var(i, j) = s_i^2 + s_j^2 (least squares). `members` index the matrix. Markers without
// enough frames get kAssumedSigmaMm.
std::vector<double> SigmasOfMembers(const Eigen::MatrixXd& variance_mm2,
                                    std::span<const int> members);

// The weights that a pose is found with: markers worse than the middle one count for less, but none
// for more, since markers that sit close together look rigid to one another wherever they go.
std::vector<double> WeightingSigmas(std::vector<double> sigmas_mm);

}  // namespace articap
