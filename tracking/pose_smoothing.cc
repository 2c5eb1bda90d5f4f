// SPDX-License-Identifier: MIT
#include "tracking/pose_smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/check.h"

namespace articap {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double kPi = std::numbers::pi;
constexpr int kOrder = 3;  // of the differences
constexpr int kFewestPoses = 30;

// Cross-validation looks at this many stretches of frames at most, spread over the take.
constexpr int kStretchLength = 1024;
constexpr int kNumStretches = 8;

constexpr int kNumCutoffs = 28;  // that cross-validation tries

// The lambda that leaves half the amplitude at a frequency, given as part of the frame rate: there
// lambda |e^(iw) - 1|^(2 order) = 1.
double LambdaOf(double relative_cutoff) {
  return std::pow(2 * std::sin(kPi * relative_cutoff), -2 * kOrder);
}

// D^T D, with D the matrix of the third differences of `size` frames; lower triangle.
Sparse DifferencePenalty(Eigen::Index size) {
  Sparse difference(size - kOrder, size);
  difference.reserve(Eigen::VectorXi::Constant(size, kOrder + 1));
  constexpr double kThirdDifference[] = {-1, 3, -3, 1};
  for (Eigen::Index i = 0; i + kOrder < size; ++i)
    for (int k = 0; k <= kOrder; ++k) difference.insert(i, i + k) = kThirdDifference[k];
  return (Sparse(difference.transpose()) * difference).triangularView<Eigen::Lower>();
}

// Frames x coordinates, and the weight of each frame; frames of weight 0 have any finite values.
struct Series {
  Eigen::MatrixXd values;
  Eigen::VectorXd weights;
};

Eigen::MatrixXd Smooth(const Series& series, const Sparse& penalty, double lambda) {
  Sparse matrix = lambda * penalty;
  // The ridge keeps a long stretch without poses definite; its poses are not used.
  matrix.diagonal() += series.weights + Eigen::VectorXd::Constant(series.weights.size(), 1e-9);
  const Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(matrix);
  ARTICAP_CHECK(factor.info() == Eigen::Success);
  // About their mean, for the sake of the last digits.
  const Eigen::RowVectorXd mean = series.weights.transpose() * series.values / series.weights.sum();
  return factor.solve(series.weights.asDiagonal() * (series.values.rowwise() - mean)).rowwise() +
         mean;
}

// How many of `size` numbers a smooth series has the freedom of: the trace of the smoother, from
// the eigenvalues of D^T D for evenly weighted frames. As many are zero as the order says; the
// others are near those of a chain with free ends, one place on.
double FreedomOf(Eigen::Index size, double lambda) {
  double sum = kOrder;
  for (Eigen::Index i = kOrder; i < size; ++i) {
    const double angle = kPi * static_cast<double>(i - 1) / (2 * static_cast<double>(size));
    sum += 1 / (1 + lambda * std::pow(2 * std::sin(angle), 2 * kOrder));
  }
  return sum;
}

// Weighted sum of squares of what smoothing takes out, and the freedom that it leaves to it.
struct Remainder {
  double sum_of_squares = 0;
  double freedom = 0;  // of each coordinate
  double count = 0;    // of each coordinate

  double Variance(Eigen::Index num_coordinates) const {
    return sum_of_squares / (freedom * static_cast<double>(num_coordinates));
  }
  // The criterion of generalised cross-validation.
  double Criterion() const { return sum_of_squares * count / (freedom * freedom); }
};

Remainder RemainderOf(const std::vector<Series>& stretches, const Sparse& penalty, double lambda) {
  const Eigen::Index size = penalty.rows();  // of every stretch
  const double taken_out = 1 - FreedomOf(size, lambda) / static_cast<double>(size);
  Remainder remainder;
  for (const Series& stretch : stretches) {
    const double known = static_cast<double>((stretch.weights.array() > 0).count());
    const Eigen::MatrixXd rest = stretch.values - Smooth(stretch, penalty, lambda);
    remainder.sum_of_squares += stretch.weights.dot(rest.rowwise().squaredNorm());
    remainder.count += known;
    remainder.freedom += known * taken_out;
  }
  return remainder;
}

// All of one length.
std::vector<Series> StretchesOf(const Series& series) {
  const Eigen::Index size = series.weights.size();
  const Eigen::Index length = std::min<Eigen::Index>(size, kStretchLength);
  const Eigen::Index count = std::min<Eigen::Index>(kNumStretches, size / length);
  std::vector<Series> stretches;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index first = count > 1 ? i * (size - length) / (count - 1) : 0;
    Series stretch{series.values.middleRows(first, length), series.weights.segment(first, length)};
    if ((stretch.weights.array() > 0).count() > kOrder) stretches.push_back(std::move(stretch));
  }
  return stretches;
}

// `cutoff`, given or found, is part of the frame rate.
struct Outcome {
  std::optional<double> cutoff;
  double noise = 0;
};

// Those that cross-validation tries, as parts of the frame rate; a given one is the only one.
std::vector<double> CutoffsToTry(double given) {
  if (given > 0) return {given};
  std::vector<double> cutoffs;
  for (int i = 0; i < kNumCutoffs; ++i)
    cutoffs.push_back(kLowestPoseCutoff * std::pow(kHighestPoseCutoff / kLowestPoseCutoff,
                                                   static_cast<double>(i) / (kNumCutoffs - 1)));
  return cutoffs;
}

Outcome SmoothSeries(double cutoff, Series* series) {
  const std::vector<Series> stretches = StretchesOf(*series);
  if (stretches.empty()) return {};
  const Sparse penalty = DifferencePenalty(stretches.front().weights.size());
  double best_criterion = std::numeric_limits<double>::infinity();
  Outcome outcome;
  for (const double tried : CutoffsToTry(cutoff)) {
    const Remainder remainder = RemainderOf(stretches, penalty, LambdaOf(tried));
    if (remainder.Criterion() < best_criterion) {
      best_criterion = remainder.Criterion();
      outcome = {tried, std::sqrt(remainder.Variance(series->values.cols()))};
    }
  }
  if (!outcome.cutoff) return {};  // nothing but poses that are not numbers
  const bool nothing_to_gain = !(cutoff > 0) && *outcome.cutoff >= kHighestPoseCutoff;
  if (nothing_to_gain) return {.cutoff = std::nullopt, .noise = outcome.noise};
  series->values =
      Smooth(*series, DifferencePenalty(series->weights.size()), LambdaOf(*outcome.cutoff));
  return outcome;
}

}  // namespace

PoseSmoothing SmoothPoses(std::span<const double> weights, const Eigen::Vector3d& pivot_in_head_mm,
                          double cutoff_hz, HeadPoseTrack* head_pose) {
  const auto num_frames = static_cast<Eigen::Index>(head_pose->poses.size());
  ARTICAP_CHECK_EQ(static_cast<Eigen::Index>(weights.size()), num_frames);
  Series pivots{Eigen::MatrixXd::Zero(num_frames, 3), Eigen::VectorXd::Zero(num_frames)};
  Eigen::MatrixXd quaternions = Eigen::MatrixXd::Zero(num_frames, 4);
  for (Eigen::Index frame = 0; frame < num_frames; ++frame) {
    const HeadPose& pose = head_pose->poses[frame];
    if (!pose.is_known()) continue;
    pivots.weights[frame] = weights[frame];
    pivots.values.row(frame) = pose.head_from_stage.Inverse() * pivot_in_head_mm;
    quaternions.row(frame) = pose.head_from_stage.rotation.coeffs();
  }
  const Eigen::Index num_known = (pivots.weights.array() > 0).count();
  if (num_known < kFewestPoses) return {};
  pivots.weights *= static_cast<double>(num_known) / pivots.weights.sum();

  // A coefficient of the quaternion is half an angle.
  const double rate_hz = head_pose->rate_hz;
  Series rotations{std::move(quaternions), pivots.weights};
  const Outcome position = SmoothSeries(cutoff_hz / rate_hz, &pivots);
  const Outcome rotation = SmoothSeries(cutoff_hz / rate_hz, &rotations);
  for (Eigen::Index frame = 0; frame < num_frames; ++frame) {
    HeadPose& pose = head_pose->poses[frame];
    if (!pose.is_known()) continue;
    pose.head_from_stage.rotation.coeffs() = rotations.values.row(frame).normalized();
    const Eigen::Vector3d pivot_in_stage_mm = pivots.values.row(frame);
    pose.head_from_stage.translation_mm =
        pivot_in_head_mm - pose.head_from_stage.rotation * pivot_in_stage_mm;
  }
  // Three of the four coefficients are free.
  const double angle = 2 * std::sqrt(4.0 / 3.0) * rotation.noise;
  const auto in_hz = [&](std::optional<double> cutoff) {
    return cutoff ? std::optional(*cutoff * rate_hz) : std::nullopt;
  };
  return {in_hz(position.cutoff), in_hz(rotation.cutoff), position.noise, angle * 180 / kPi};
}

}  // namespace articap
