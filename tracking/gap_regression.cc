// SPDX-License-Identifier: MIT
#include "tracking/gap_regression.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/check.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

constexpr int kMostOffsets = 5;         // frames of a window that regression looks at
constexpr int kMostPooled = 12;         // markers
constexpr int kFewestWindows = 40;      // to regress
constexpr int kFewestKnownWindows = 4;  // to say how large a marker's errors are
constexpr double kFewestKnown = 0.25;   // part of its frames, for a marker to be learnt from
constexpr int kNumFolds = 3;            // of cross-validation
// Frames. Over shorter gaps there is little to regress, and in takes that are full of them what is
// imputed below would tell itself.
constexpr int kShortest = 4;
// Ridges to try, as parts of the mean variance of the deviations; and the one that is good enough
// to impute with.
constexpr std::array kRidges = {0.002, 0.01, 0.05, 0.25, 1.0, 10.0};
constexpr double kImputingRidge = 0.2;
constexpr int kMostImputations = 8;
const double kNotKnown = std::numeric_limits<double>::quiet_NaN();

std::vector<int> OftenKnown(const Knowledge& knowledge) {
  std::vector<int> markers;
  for (int marker = 0; marker < knowledge.num_markers(); ++marker)
    if (knowledge.PartKnown(marker) >= kFewestKnown) markers.push_back(marker);
  return markers;
}

// X^T X.
Eigen::MatrixXd ProductsOf(const Eigen::Ref<const Eigen::MatrixXd>& deviations_mm) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(deviations_mm.cols(), deviations_mm.cols());
  products.selfadjointView<Eigen::Lower>().rankUpdate(deviations_mm.transpose());
  products.triangularView<Eigen::StrictlyUpper>() = products.transpose();
  return products;
}

Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& deviations_mm) {
  return ProductsOf(deviations_mm) / static_cast<double>(deviations_mm.rows());
}

// The inverse of a covariance with a ridge, given as part of its mean variance.
Eigen::MatrixXd PrecisionOf(Eigen::MatrixXd covariance_mm2, double ridge) {
  constexpr double kSmallest_mm2 = 1e-12;  // something, where nothing moves
  covariance_mm2.diagonal().array() +=
      ridge * std::max(kSmallest_mm2, covariance_mm2.diagonal().mean());
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance_mm2);
  ARTICAP_CHECK(factor.info() == Eigen::Success);
  return factor.solve(Eigen::MatrixXd::Identity(covariance_mm2.rows(), covariance_mm2.cols()));
}

// Columns that turn deviations of all markers into what is left of the given ones, three columns
// each, by regression on all others: P_m P_mm^-1.
Eigen::MatrixXd LeftByOthers(const Eigen::MatrixXd& precision, const std::vector<int>& markers) {
  Eigen::MatrixXd left = precision(Eigen::all, ColumnsOf(markers));
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const Eigen::Matrix3d own = precision.block<3, 3>(3 * markers[i], 3 * markers[i]);
    left.middleCols<3>(3 * static_cast<Eigen::Index>(i)) *= own.inverse();
  }
  return left;
}

}  // namespace

// Windows first ... last - 1 are predicted from those that share no frame with them.
struct GapRegression::Fold {
  int first = 0;
  int last = 0;
  Eigen::MatrixXd covariance_mm2;  // of the others
};

GapRegression::GapRegression(const Knowledge& knowledge, const Eigen::MatrixXd& series,
                             const GapShape& shape)
    : knowledge_(knowledge), series_(series), windows_(MakeWindows(knowledge, shape)) {
  const int num_offsets = std::min(kMostOffsets, shape.length);
  for (int i = 0; i < num_offsets; ++i)
    offsets_.push_back((2 * i + 1) * shape.length / (2 * num_offsets));
  all_.resize(knowledge.num_markers());
  std::iota(all_.begin(), all_.end(), 0);
  const std::vector<int> often_known = OftenKnown(knowledge);
  for (const int i : SpreadFrames(static_cast<int>(often_known.size()), kMostPooled))
    pooled_.push_back(often_known[i]);
  pooled_series_ = series(Eigen::all, ColumnsOf(pooled_));
  interpolation_.rms_mm = Eigen::VectorXd::Constant(num_markers(), kNotKnown);
  if (windows_.size() == 0) return;
  const Eigen::MatrixXd movement_mm = DeviationsFrom(LinearWeights(shape));
  Eigen::MatrixXd deviations_mm = DeviationsFrom(WeightsFor(shape).weights);
  interpolation_ = LearnErrors(movement_mm, deviations_mm);
  if (shape.length >= kShortest && windows_.size() >= kFewestWindows && pooled_.size() >= 2)
    LearnRegression(movement_mm, std::move(deviations_mm));
}

// What the series stray from interpolation, in the windows, one after another; zero where they are
// not known.
Eigen::MatrixXd GapRegression::DeviationsFrom(const Eigen::MatrixXd& weights) const {
  const Eigen::MatrixXd rows_of_weights = weights(offsets_, Eigen::all);
  Eigen::MatrixXd deviations_mm(windows_.size() * num_rows(), series_.cols());
  for (int window = 0; window < windows_.size(); ++window) {
    const int first = windows_.firsts[window];
    auto rows = deviations_mm.middleRows(window * num_rows(), num_rows());
    rows.noalias() = -rows_of_weights * ContextOf(series_, first, windows_.shape);
    for (int i = 0; i < num_rows(); ++i) rows.row(i) += series_.row(first + offsets_[i]);
    for (const int marker : all_)
      if (!windows_.known(window, marker)) rows.middleCols<3>(3 * marker).setZero();
  }
  return deviations_mm;
}

void GapRegression::LearnRegression(const Eigen::MatrixXd& movement_mm,
                                    Eigen::MatrixXd deviations_mm) {
  Impute(deviations_mm);
  const std::vector<Fold> folds = MakeFolds(deviations_mm);
  const double ridge = ChooseRidge(deviations_mm, folds);
  regression_ = LearnErrors(movement_mm, CrossValidate(deviations_mm, folds, ridge, all_));
  precision_ = PrecisionOf(CovarianceOf(deviations_mm), ridge);
}

double GapRegression::ChooseRidge(const Eigen::MatrixXd& deviations_mm,
                                  const std::vector<Fold>& folds) const {
  double best = kRidges.back();
  double least_mm2 = std::numeric_limits<double>::infinity();
  for (const double ridge : kRidges) {
    const Eigen::ArrayXd rms_mm =
        RmsOf(CrossValidate(deviations_mm, folds, ridge, pooled_), pooled_);
    const double sum_mm2 = rms_mm.isNaN().select(0.0, rms_mm.square()).sum();
    if (sum_mm2 >= least_mm2) continue;
    least_mm2 = sum_mm2;
    best = ridge;
  }
  return best;
}

// Deviations that are not known become what regression on the others expects, so that they neither
// add to nor take from what is known: the expectation of EM, without its variance, which would only
// concern the imputed themselves. Markers that are unknown together are dealt with in turns.
void GapRegression::Impute(Eigen::MatrixXd& deviations_mm) const {
  if (windows_.known.all()) return;
  constexpr double kSettled = 1e-3;  // part of the mean square
  for (int i = 0; i < kMostImputations; ++i) {
    const Eigen::MatrixXd left =
        LeftByOthers(PrecisionOf(CovarianceOf(deviations_mm), kImputingRidge), all_);
    double change_mm2 = 0;
    for (int window = 0; window < windows_.size(); ++window)
      for (const int marker : all_) {
        if (windows_.known(window, marker)) continue;
        auto rows = deviations_mm.middleRows(window * num_rows(), num_rows());
        const Eigen::MatrixXd change = rows * left.middleCols<3>(3 * marker);
        rows.middleCols<3>(3 * marker) -= change;
        change_mm2 += change.squaredNorm();
      }
    if (change_mm2 <= kSettled * deviations_mm.squaredNorm()) return;
  }
}

std::vector<GapRegression::Fold> GapRegression::MakeFolds(
    const Eigen::MatrixXd& deviations_mm) const {
  const Eigen::MatrixXd products_mm2 = ProductsOf(deviations_mm);
  std::vector<Fold> folds;
  for (int i = 0; i < kNumFolds; ++i) {
    Fold fold{windows_.size() * i / kNumFolds, windows_.size() * (i + 1) / kNumFolds, {}};
    int first = fold.first;
    while (first > 0 && windows_.end(first - 1) > windows_.begin(fold.first)) --first;
    int last = fold.last;
    while (last < windows_.size() && windows_.begin(last) < windows_.end(fold.last - 1)) ++last;
    const int num_others = std::max(1, windows_.size() - (last - first));
    fold.covariance_mm2 = (products_mm2 - ProductsOf(deviations_mm.middleRows(
                                              first * num_rows(), (last - first) * num_rows()))) /
                          (num_others * num_rows());
    folds.push_back(std::move(fold));
  }
  return folds;
}

// Errors of regression on all other markers, each window predicted from the other folds.
Eigen::MatrixXd GapRegression::CrossValidate(const Eigen::MatrixXd& deviations_mm,
                                             const std::vector<Fold>& folds, double ridge,
                                             const std::vector<int>& markers) const {
  Eigen::MatrixXd errors_mm(deviations_mm.rows(), 3 * static_cast<Eigen::Index>(markers.size()));
  for (const Fold& fold : folds) {
    const int first = fold.first * num_rows();
    const int count = (fold.last - fold.first) * num_rows();
    errors_mm.middleRows(first, count).noalias() =
        deviations_mm.middleRows(first, count) *
        LeftByOthers(PrecisionOf(fold.covariance_mm2, ridge), markers);
  }
  return errors_mm;
}

Eigen::VectorXd GapRegression::RmsOf(const Eigen::MatrixXd& errors_mm,
                                     const std::vector<int>& markers) const {
  Eigen::VectorXd rms_mm =
      Eigen::VectorXd::Constant(static_cast<Eigen::Index>(markers.size()), kNotKnown);
  for (Eigen::Index i = 0; i < rms_mm.size(); ++i) {
    double sum_mm2 = 0;
    int count = 0;
    for (int window = 0; window < windows_.size(); ++window) {
      if (!windows_.known(window, markers[i])) continue;
      sum_mm2 += errors_mm.block(window * num_rows(), 3 * i, num_rows(), 3).squaredNorm();
      ++count;
    }
    if (count >= kFewestKnownWindows) rms_mm[i] = std::sqrt(sum_mm2 / (3.0 * count * num_rows()));
  }
  return rms_mm;
}

GapRegression::Errors GapRegression::LearnErrors(const Eigen::MatrixXd& movement_mm,
                                                 const Eigen::MatrixXd& errors_mm) const {
  const Eigen::MatrixXd predicted_mm = movement_mm - errors_mm;
  Errors errors{RmsOf(errors_mm, all_), RmsOf(predicted_mm, all_), {}};
  const auto relative_square = [&](const Eigen::MatrixXd& values_mm, int window, int marker,
                                   double rms_mm) {
    return values_mm.block(window * num_rows(), 3 * marker, num_rows(), 3).squaredNorm() /
           (3.0 * num_rows() * rms_mm * rms_mm);
  };
  std::vector<double> activities;
  std::vector<double> relative_squares;
  for (int window = 0; window < windows_.size(); ++window)
    for (const int marker : all_) {
      const double rms_mm = errors.rms_mm[marker];
      const double movement_rms_mm = errors.movement_rms_mm[marker];
      if (!windows_.known(window, marker) || !(rms_mm > 0) || !(movement_rms_mm > 0)) continue;
      activities.push_back(relative_square(predicted_mm, window, marker, movement_rms_mm));
      relative_squares.push_back(relative_square(errors_mm, window, marker, rms_mm));
    }
  errors.activity = FitActivity(activities, relative_squares);
  return errors;
}

double GapRegression::Errors::SigmaOf(int marker, const Eigen::MatrixXd& movement_mm) const {
  const double mean_mm2 = std::pow(movement_rms_mm[marker], 2);
  const double relative_square =
      mean_mm2 > 0
          ? movement_mm.squaredNorm() / (static_cast<double>(movement_mm.size()) * mean_mm2)
          : 1;
  return rms_mm[marker] * std::sqrt(activity.VarianceFactor(relative_square));
}

const GapWeights& GapRegression::WeightsFor(const GapShape& shape) {
  const auto found = weights_.find(shape);
  if (found != weights_.end()) return found->second;
  const GapWeights weights =
      shape == windows_.shape
          ? LearnWeights(windows_, pooled_series_, pooled_)
          : LearnWeights(MakeWindows(knowledge_, shape), pooled_series_, pooled_);
  return weights_.emplace(shape, weights).first->second;
}

// The marker itself, then the others that do not serve.
std::vector<int> GapRegression::UnknownIn(const Gap& gap, const GapShape& shape) const {
  std::vector<int> unknown = {gap.marker};
  for (const int marker : all_) {
    const bool is_known =
        interpolation_.rms_mm[marker] >= 0 &&
        knowledge_.IsKnown(marker, gap.first - shape.before, gap.first + gap.length + shape.after,
                           LongestFillFor(gap.length));
    if (!is_known && marker != gap.marker) unknown.push_back(marker);
  }
  return unknown;
}

// Nothing where interpolation alone does better. `interpolated_mm`: all markers, as if they were
// missing.
std::optional<GapRegression::Correction> GapRegression::Regress(
    const Gap& gap, const GapShape& shape, const Eigen::MatrixXd& interpolated_mm) const {
  const std::vector<int> unknown = UnknownIn(gap, shape);
  if (precision_.size() == 0 || static_cast<int>(unknown.size()) == num_markers())
    return std::nullopt;
  const std::vector<int> columns = ColumnsOf(unknown);
  const auto size = static_cast<Eigen::Index>(columns.size());
  const Eigen::MatrixXd covariance_mm2 =
      precision_(columns, columns).llt().solve(Eigen::MatrixXd::Identity(size, 3));
  // Cross-validation knows the error with all others; with fewer it grows as the variances do.
  const Eigen::Matrix3d with_all_mm2 =
      precision_.block<3, 3>(3 * gap.marker, 3 * gap.marker).inverse();
  const double growth = std::sqrt(covariance_mm2.topRows<3>().trace() / with_all_mm2.trace());
  if (!(growth * regression_.rms_mm[gap.marker] < interpolation_.rms_mm[gap.marker]))
    return std::nullopt;
  Eigen::MatrixXd deviations_mm = series_.middleRows(gap.first, gap.length) - interpolated_mm;
  for (const int column : columns) deviations_mm.col(column).setZero();
  return Correction{-deviations_mm * (precision_(Eigen::all, columns) * covariance_mm2), growth};
}

GapFill GapRegression::Fill(const Gap& gap, const GapShape& shape) {
  const GapWeights& weights = WeightsFor(shape);
  const Eigen::MatrixXd context_mm = ContextOf(series_, gap.first, shape);
  const Eigen::MatrixXd interpolated_mm = weights.weights * context_mm;
  const auto correction = Regress(gap, shape, interpolated_mm);
  GapFill fill;
  fill.is_regression = correction.has_value();
  fill.positions_mm = interpolated_mm.middleCols<3>(3 * gap.marker);
  if (correction) fill.positions_mm += correction->positions_mm;
  fill.sigmas_mm = Eigen::VectorXd::Constant(gap.length, kNotKnown);
  if (weights.profile.size() == 0) return fill;
  const Eigen::MatrixXd movement_mm =
      fill.positions_mm - LinearWeights(shape) * context_mm.middleCols<3>(3 * gap.marker);
  fill.sigmas_mm = weights.profile * (correction ? correction->error_growth *
                                                       regression_.SigmaOf(gap.marker, movement_mm)
                                                 : interpolation_.SigmaOf(gap.marker, movement_mm));
  return fill;
}

}  // namespace articap
