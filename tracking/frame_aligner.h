// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/tracks.h"
#include "core/transforms.h"

namespace articap {

// The reference markers and where they lie against one another.
struct ReferenceModel {
  std::vector<int> columns;                // of the tracks
  std::vector<Eigen::Vector3d> points_mm;  // in the frame of the shape; NaN where not known
  // Standard deviation of each coordinate: noise and the skin's own movement together.
  std::vector<double> sigmas_mm;

  int size() const { return static_cast<int>(columns.size()); }
};

struct AlignerOptions {
  double outlier_sigmas = 4;
  bool use_filled = false;
};

// How the reference shape lies in one frame.
struct FrameAlignment {
  Rigid3d shape_from_stage;       // identity where fewer than three references are seen
  int num_seen = 0;               // references seen, of those whose place in the shape is known
  int num_used = 0;               // of these: not outliers
  double rms_mm = 0;              // over the references used
  double rotation_sigma_rad = 0;  // predicted, of the worst-determined angle
};

// Aligns the reference shape to the frames of a take, one by one and independent of one another.
// Weighted least squares; where a reference then lies further off than outlier_sigmas, robust:
// iteratively re-weighted with the weights 1 for r <= c, (c/r)^4 beyond (r the residual over
// its sigma), c brought down step by step from the largest residual to outlier_sigmas
// (graduated non-convexity, Blake and Zisserman 1987), so that the result does not depend on which
// reference the first fit was drawn to. Frames without outliers are exactly least squares.
class FrameAligner {
 public:
  FrameAligner(const StageTracks& tracks, ReferenceModel model, const AlignerOptions& options);

  FrameAlignment Align(int frame);

  // Of the frame aligned last, a reference each: distance from its place in the shape (NaN where
  // it is not seen) and robust weight (0 where it is not seen).
  std::span<const double> residuals_mm() const { return residuals_mm_; }
  std::span<const double> robust_weights() const { return robust_weights_; }
  bool IsOutlier(int reference) const { return robust_weights_[reference] < kOutlierWeight; }

  const ReferenceModel& model() const { return model_; }
  void SetPoints(const std::vector<Eigen::Vector3d>& points_mm) { model_.points_mm = points_mm; }
  void SetSigmas(const std::vector<double>& sigmas_mm);

 private:
  static constexpr double kOutlierWeight = 0.5;

  void FindUnstatedVariance();
  void Gather(int frame);
  void FitAndMeasure(FrameAlignment& alignment);
  void FitRobustly(FrameAlignment& alignment);
  double LargestResidual() const;

  const StageTracks& tracks_;
  ReferenceModel model_;
  AlignerOptions options_;
  // Where a file states sigmas they hold; what the data show beyond them (skin) is added:
  // variance = stated^2 + unstated.
  std::vector<double> mean_stated_variance_mm2_;  // NaN where nothing is stated
  std::vector<double> unstated_variance_mm2_;

  // Of the current frame.
  std::vector<Eigen::Vector3d> points_in_stage_mm_;
  std::vector<double> sample_sigmas_mm_;
  std::vector<double> weights_;
  std::vector<double> robust_weights_;
  std::vector<double> residuals_mm_;
};

}  // namespace articap
