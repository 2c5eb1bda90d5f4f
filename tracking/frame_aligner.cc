// SPDX-License-Identifier: MIT
#include "tracking/frame_aligner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/alignment.h"
#include "core/check.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Mean square of the sigmas that the file states for a marker, over at most a thousand frames; NaN
// where it states none.
double MeanStatedVariance(const StageTracks& tracks, int marker) {
  double sum = 0;
  int count = 0;
  const int step = std::max(1, tracks.num_frames() / 1000);
  for (int frame = 0; frame < tracks.num_frames(); frame += step) {
    const double sigma_mm = tracks.sigma_mm(frame, marker);
    if (!std::isfinite(sigma_mm)) continue;
    sum += sigma_mm * sigma_mm;
    ++count;
  }
  return count > 0 ? sum / count : kNaN;
}

}  // namespace

FrameAligner::FrameAligner(const StageTracks& tracks, ReferenceModel model,
                           const AlignerOptions& options)
    : tracks_(tracks), model_(std::move(model)), options_(options) {
  const std::size_t size = model_.columns.size();
  ARTICAP_CHECK_EQ(model_.points_mm.size(), size);
  ARTICAP_CHECK_EQ(model_.sigmas_mm.size(), size);
  for (const int column : model_.columns)
    mean_stated_variance_mm2_.push_back(MeanStatedVariance(tracks, column));
  FindUnstatedVariance();
  points_in_stage_mm_.resize(size);
  sample_sigmas_mm_.resize(size);
  weights_.resize(size);
  robust_weights_.resize(size);
  residuals_mm_.resize(size);
}

void FrameAligner::SetSigmas(const std::vector<double>& sigmas_mm) {
  ARTICAP_CHECK_EQ(sigmas_mm.size(), model_.columns.size());
  model_.sigmas_mm = sigmas_mm;
  FindUnstatedVariance();
}

void FrameAligner::FindUnstatedVariance() {
  unstated_variance_mm2_.clear();
  for (int i = 0; i < model_.size(); ++i) {
    const double stated = mean_stated_variance_mm2_[i];
    const double found = model_.sigmas_mm[i] * model_.sigmas_mm[i];
    unstated_variance_mm2_.push_back(stated < found ? found - stated : 0.0);
  }
}

void FrameAligner::Gather(int frame) {
  for (int i = 0; i < model_.size(); ++i) {
    const int column = model_.columns[i];
    const SampleState state = tracks_.state(frame, column);
    const bool is_seen =
        state == SampleState::kMeasured || (state == SampleState::kFilled && options_.use_filled);
    points_in_stage_mm_[i] = tracks_.position_mm(frame, column);
    if (!is_seen || !model_.points_mm[i].allFinite()) {
      weights_[i] = 0;
      robust_weights_[i] = 0;
      residuals_mm_[i] = kNaN;
      continue;
    }
    const double stated = tracks_.sigma_mm(frame, column);
    const double variance = std::isfinite(stated) ? stated * stated + unstated_variance_mm2_[i]
                                                  : model_.sigmas_mm[i] * model_.sigmas_mm[i];
    sample_sigmas_mm_[i] = std::sqrt(std::max(variance, kSmallestSigmaMm * kSmallestSigmaMm));
    weights_[i] = 1 / (sample_sigmas_mm_[i] * sample_sigmas_mm_[i]);
    robust_weights_[i] = 1;
  }
}

void FrameAligner::FitAndMeasure(FrameAlignment& alignment) {
  alignment.shape_from_stage = AlignRigid(points_in_stage_mm_, model_.points_mm, weights_);
  const Eigen::Matrix3d rotation = alignment.shape_from_stage.rotation.toRotationMatrix();
  const Eigen::Vector3d& translation_mm = alignment.shape_from_stage.translation_mm;
  for (int i = 0; i < model_.size(); ++i)
    if (robust_weights_[i] > 0)
      residuals_mm_[i] =
          (rotation * points_in_stage_mm_[i] + translation_mm - model_.points_mm[i]).norm();
}

double FrameAligner::LargestResidual() const {
  double largest = 0;
  for (int i = 0; i < model_.size(); ++i)
    if (robust_weights_[i] > 0)
      largest = std::max(largest, residuals_mm_[i] / sample_sigmas_mm_[i]);
  return largest;
}

void FrameAligner::FitRobustly(FrameAlignment& alignment) {
  constexpr double kStep = 0.6;              // from one threshold to the next
  constexpr double kSettled = 1e-3;          // change of a weight
  constexpr int kMaxFinalIterations = 10;    // at the last threshold
  constexpr double kSmallestWeight = 1e-12;  // keeps "seen" apart from "not seen"
  double threshold = LargestResidual();
  for (int final_iterations = 0; final_iterations < kMaxFinalIterations;) {
    threshold = std::max(options_.outlier_sigmas, threshold * kStep);
    const bool is_final = threshold <= options_.outlier_sigmas;
    final_iterations += is_final;
    double largest_change = 0;
    for (int i = 0; i < model_.size(); ++i) {
      if (!(robust_weights_[i] > 0)) continue;
      const double ratio = threshold * sample_sigmas_mm_[i] / residuals_mm_[i];
      const double weight =
          ratio >= 1 ? 1.0 : std::max(ratio * ratio * ratio * ratio, kSmallestWeight);
      largest_change = std::max(largest_change, std::abs(weight - robust_weights_[i]));
      robust_weights_[i] = weight;
      weights_[i] = weight / (sample_sigmas_mm_[i] * sample_sigmas_mm_[i]);
    }
    if (is_final && largest_change < kSettled) break;
    FitAndMeasure(alignment);
  }
}

FrameAlignment FrameAligner::Align(int frame) {
  Gather(frame);
  FrameAlignment alignment;
  for (const double weight : robust_weights_) alignment.num_seen += weight > 0;
  alignment.rms_mm = kNaN;
  alignment.rotation_sigma_rad = std::numeric_limits<double>::infinity();
  if (alignment.num_seen < 3) return alignment;

  FitAndMeasure(alignment);
  if (LargestResidual() > options_.outlier_sigmas) FitRobustly(alignment);

  double sum_of_squares = 0;
  for (int i = 0; i < model_.size(); ++i) {
    if (IsOutlier(i)) continue;
    ++alignment.num_used;
    sum_of_squares += residuals_mm_[i] * residuals_mm_[i];
  }
  if (alignment.num_used > 0) alignment.rms_mm = std::sqrt(sum_of_squares / alignment.num_used);
  alignment.rotation_sigma_rad = WorstRotationSigma(model_.points_mm, weights_);
  return alignment;
}

}  // namespace articap
