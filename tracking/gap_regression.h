// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "tracking/gap_activity.h"
#include "tracking/gap_weights.h"
#include "tracking/gap_windows.h"

namespace articap {

// What fills a gap, in the frame of the series.
struct GapFill {
  Eigen::MatrixXd positions_mm;  // frames of the gap x 3
  // Standard deviation of each coordinate against a measured one, one a frame; NaN where the take
  // is too short to tell.
  Eigen::VectorXd sigmas_mm;
  bool is_regression = false;  // or interpolation alone
};

// Fills gaps of about one length from the marker's own neighbouring frames and from the other
// markers. With y the missing marker, x the others, and W interpolation over the gap by the frames
// beside it (GapWeights),
//   y = W y + B (x - W x):
// where the others stray from what interpolation expects of them, so does this one. The same
// read otherwise, B x + W (y - B x), is regression with its offset at the edges interpolated. B is
// learnt from windows of the same length all over the take, which makes it the best for this
// length: over short gaps interpolation is nearly true, and little is left to regress. The ridge is
// chosen by cross-validation over stretches of the take; its errors there tell the sigmas.
//
// As in a joint normal distribution, the regression on any set of others follows from one matrix:
// with P the inverse of the covariance and its ridge, the unknown u are -P_uu^-1 P_ux x, and
// P_uu^-1 is their covariance.
class GapRegression {
 public:
  // `shape`: the length, and 0 or GapShape::kMostContext frames on either side. The series have
  // three columns for each marker of the knowledge (LocalSeries); both must outlive this.
  GapRegression(const Knowledge& knowledge, const Eigen::MatrixXd& series, const GapShape& shape);

  // The gap's length need not be that of the windows, but near it; its sides must be the same.
  GapFill Fill(const Gap& gap, const GapShape& shape);

 private:
  struct Fold;

  // Of interpolation, or of regression. Where a gap is filled with more movement than usual, it is
  // further off; the movement is what strays from a straight line across the gap.
  struct Errors {
    // RMS of a coordinate, one a marker; NaN where not known.
    Eigen::VectorXd rms_mm;
    Eigen::VectorXd movement_rms_mm;
    ActivityModel activity;

    double SigmaOf(int marker, const Eigen::MatrixXd& movement_mm) const;
  };

  // What regression adds to interpolation.
  struct Correction {
    Eigen::MatrixXd positions_mm;  // frames of the gap x 3
    double error_growth = 1;       // against regression on all others
  };

  int num_markers() const { return knowledge_.num_markers(); }
  int num_rows() const { return static_cast<int>(offsets_.size()); }

  Eigen::MatrixXd DeviationsFrom(const Eigen::MatrixXd& weights) const;
  void LearnRegression(const Eigen::MatrixXd& movement_mm, Eigen::MatrixXd deviations_mm);
  void Impute(Eigen::MatrixXd& deviations_mm) const;
  std::vector<Fold> MakeFolds(const Eigen::MatrixXd& deviations_mm) const;
  double ChooseRidge(const Eigen::MatrixXd& deviations_mm, const std::vector<Fold>& folds) const;
  Eigen::MatrixXd CrossValidate(const Eigen::MatrixXd& deviations_mm,
                                const std::vector<Fold>& folds, double ridge,
                                const std::vector<int>& markers) const;
  Eigen::VectorXd RmsOf(const Eigen::MatrixXd& errors_mm, const std::vector<int>& markers) const;
  Errors LearnErrors(const Eigen::MatrixXd& movement_mm, const Eigen::MatrixXd& errors_mm) const;
  std::vector<int> UnknownIn(const Gap& gap, const GapShape& shape) const;
  std::optional<Correction> Regress(const Gap& gap, const GapShape& shape,
                                    const Eigen::MatrixXd& interpolated_mm) const;
  const GapWeights& WeightsFor(const GapShape& shape);

  const Knowledge& knowledge_;
  const Eigen::MatrixXd& series_;
  GapWindows windows_;
  std::vector<int> offsets_;  // frames of the gap that are looked at
  std::vector<int> all_;      // markers
  std::vector<int> pooled_;   // markers that weights and the ridge are learnt from
  Eigen::MatrixXd pooled_series_;
  std::map<GapShape, GapWeights> weights_;
  Errors interpolation_;
  Errors regression_;          // on all others
  Eigen::MatrixXd precision_;  // P of deviations, 1/mm^2; empty where nothing can be regressed
};

}  // namespace articap
