// SPDX-License-Identifier: MIT
#include "tracking/gap_weights.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace articap {
namespace {

// Part of the mean square of the slopes that learning starts from.
constexpr double kRidge = 1e-6;

// Rows that give, of the frames beside a gap, the slopes from each frame to the next one towards
// the gap, less the slope across the gap: zero for a straight line.
Eigen::MatrixXd SlopesOf(const GapShape& shape) {
  const int num_slopes = std::max(0, shape.before - 1) + std::max(0, shape.after - 1);
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(num_slopes, shape.num_context());
  int row = 0;
  for (int i = 0; i < shape.num_context(); ++i) {
    if (i == shape.before - 1 || i == shape.before) continue;
    const int earlier = i < shape.before ? i : i - 1;
    slopes(row, earlier + 1) += 1;
    slopes(row, earlier) -= 1;
    if (shape.before > 0 && shape.after > 0) {
      slopes(row, shape.before) -= 1.0 / (shape.length + 1);
      slopes(row, shape.before - 1) += 1.0 / (shape.length + 1);
    }
    ++row;
  }
  return slopes;
}

// Columns of unknown markers become zero, the others are scaled.
Eigen::MatrixXd MaskAndScale(Eigen::MatrixXd values, const GapWindows& windows, int window,
                             const std::vector<int>& column_markers,
                             const Eigen::VectorXd& scales) {
  for (std::size_t i = 0; i < column_markers.size(); ++i) {
    const auto column = 3 * static_cast<Eigen::Index>(i);
    if (windows.known(window, column_markers[i]))
      values.middleCols<3>(column) *= scales.segment<3>(column).asDiagonal();
    else
      values.middleCols<3>(column).setZero();
  }
  return values;
}

// One over the root mean square of what linear interpolation leaves.
Eigen::VectorXd ScalesOf(const GapWindows& windows, const Eigen::MatrixXd& series,
                         const std::vector<int>& column_markers, const Eigen::MatrixXd& linear) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(series.cols());
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(series.cols());
  for (int window = 0; window < windows.size(); ++window) {
    const int first = windows.firsts[window];
    const Eigen::MatrixXd left = series.middleRows(first, windows.shape.length) -
                                 linear * ContextOf(series, first, windows.shape);
    sums += MaskAndScale(left, windows, window, column_markers, ones)
                .colwise()
                .squaredNorm()
                .transpose();
  }
  const double largest = sums.size() > 0 ? sums.maxCoeff() : 0.0;
  // Columns that do not move say nothing.
  constexpr double kStill = 1e-12;
  return (sums.array() > kStill * largest).select(sums.array().max(1e-300).rsqrt(), 0.0);
}

// Sums over windows and columns of what the slopes beside a gap and what linear interpolation
// leaves in it have to do with one another.
struct Moments {
  Eigen::MatrixXd of_slopes;  // slopes x slopes
  Eigen::MatrixXd with_left;  // slopes x frames of the gap
  Eigen::VectorXd of_left;    // squares, one a frame of the gap
};

Moments MomentsOf(const GapWindows& windows, const Eigen::MatrixXd& series,
                  const std::vector<int>& column_markers, const Eigen::MatrixXd& linear,
                  const Eigen::MatrixXd& slopes_of) {
  const GapShape& shape = windows.shape;
  const Eigen::VectorXd scales = ScalesOf(windows, series, column_markers, linear);
  Moments moments{Eigen::MatrixXd::Zero(slopes_of.rows(), slopes_of.rows()),
                  Eigen::MatrixXd::Zero(slopes_of.rows(), shape.length),
                  Eigen::VectorXd::Zero(shape.length)};
  for (int window = 0; window < windows.size(); ++window) {
    const int first = windows.firsts[window];
    const Eigen::MatrixXd context =
        MaskAndScale(ContextOf(series, first, shape), windows, window, column_markers, scales);
    const Eigen::MatrixXd inside = MaskAndScale(series.middleRows(first, shape.length), windows,
                                                window, column_markers, scales);
    const Eigen::MatrixXd left = inside - linear * context;
    const Eigen::MatrixXd slopes = slopes_of * context;
    moments.of_slopes.noalias() += slopes * slopes.transpose();
    moments.with_left.noalias() += slopes * left.transpose();
    moments.of_left += left.rowwise().squaredNorm();
  }
  return moments;
}

}  // namespace

Eigen::MatrixXd LinearWeights(const GapShape& shape) {
  ARTICAP_CHECK_GT(shape.num_context(), 0);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(shape.length, shape.num_context());
  for (int k = 0; k < shape.length; ++k) {
    double part = (k + 1.0) / (shape.length + 1);
    if (shape.before == 0) part = 1;
    if (shape.after == 0) part = 0;
    if (shape.before > 0) weights(k, shape.before - 1) += 1 - part;
    if (shape.after > 0) weights(k, shape.before) += part;
  }
  return weights;
}

GapWeights CubicWeights(const GapShape& shape) {
  GapWeights cubic{LinearWeights(shape), {}};
  if (shape.before < 2 || shape.after < 2) return cubic;
  const Eigen::MatrixXd slopes = SlopesOf(shape);
  const double steps = shape.length + 1;
  for (int k = 0; k < shape.length; ++k) {
    const double u = (k + 1) / steps;
    cubic.weights.row(k) += steps * (u * (1 - u) * (1 - u) * slopes.row(shape.before - 2) -
                                     u * u * (1 - u) * slopes.row(shape.before - 1));
  }
  return cubic;
}

GapWeights LearnWeights(const GapWindows& windows, const Eigen::MatrixXd& series,
                        const std::vector<int>& column_markers) {
  ARTICAP_CHECK_EQ(series.cols(), 3 * static_cast<Eigen::Index>(column_markers.size()));
  const GapShape& shape = windows.shape;
  Eigen::Index num_known = 0;
  for (const int marker : column_markers)
    if (windows.size() > 0) num_known += windows.known.col(marker).count();
  if (num_known < kFewestSamplesAFrame * shape.num_context()) return CubicWeights(shape);

  GapWeights learnt{LinearWeights(shape), {}};
  const Eigen::MatrixXd slopes_of = SlopesOf(shape);
  const Moments moments = MomentsOf(windows, series, column_markers, learnt.weights, slopes_of);
  Eigen::VectorXd squares = moments.of_left;
  if (moments.of_slopes.trace() > 0) {
    Eigen::MatrixXd regular = moments.of_slopes;
    regular.diagonal().array() += kRidge * regular.diagonal().mean();
    const Eigen::MatrixXd of_slopes = regular.ldlt().solve(moments.with_left);
    learnt.weights += of_slopes.transpose() * slopes_of;
    const Eigen::MatrixXd explained = 2 * moments.with_left.cwiseProduct(of_slopes) -
                                      (moments.of_slopes * of_slopes).cwiseProduct(of_slopes);
    squares -= explained.colwise().sum().transpose();
  }
  const double mean = std::max(0.0, squares.mean());
  learnt.profile = mean > 0 ? Eigen::VectorXd((squares.cwiseMax(0) / mean).cwiseSqrt())
                            : Eigen::VectorXd(Eigen::VectorXd::Ones(shape.length));
  return learnt;
}

}  // namespace articap
