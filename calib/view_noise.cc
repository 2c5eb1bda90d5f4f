// SPDX-License-Identifier: MIT
#include "calib/view_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace articap {
namespace {

// From fewer residuals the noise would be known to no better than 13 %, 1 / sqrt(2 n).
constexpr double kFewest = 30;

// Of a view that keeps less of its residuals the others tell the noise rather than it does: of two
// rays that meet in a point, say, nobody knows which one is off.
constexpr double kLeastShare = 0.5;

// Of each corner that has neighbours to both sides, along a row or a column of the board.
void AddSecondDifferences(const BoardSpec& board, const std::vector<int>& corners,
                          const std::vector<Eigen::Vector2d>& residuals_px,
                          std::vector<double>& distances_px) {
  std::vector<const Eigen::Vector2d*> at(static_cast<std::size_t>(board.num_corners()), nullptr);
  for (std::size_t i = 0; i < corners.size(); ++i) at[corners[i]] = &residuals_px[i];
  const auto add = [&](int corner, int step) {
    const auto *before = at[corner - step], *behind = at[corner + step];
    if (before != nullptr && behind != nullptr)
      distances_px.push_back((*before - 2 * *at[corner] + *behind).norm());
  };
  const int columns = board.corner_columns();
  for (int corner : corners) {
    const int column = corner % columns, row = corner / columns;
    if (column > 0 && column + 1 < columns) add(corner, 1);
    if (row > 0 && row + 1 < board.corner_rows()) add(corner, columns);
  }
}

}  // namespace

std::vector<double> LocalNoiseOfViews_px(const AdjustedNetwork& adjusted) {
  const Network& network = adjusted.network;
  std::vector<std::vector<double>> distances_px(network.array.views().size());
  for (std::size_t i = 0; i < network.sightings.size(); ++i) {
    const NetworkSighting& sighting = network.sightings[i];
    AddSecondDifferences(network.board, sighting.corners, adjusted.residuals_px[i],
                         distances_px[network.array.IndexOf(sighting.view)]);
  }
  std::vector<double> noise_px;
  for (std::vector<double>& of_view_px : distances_px)
    noise_px.push_back(static_cast<double>(of_view_px.size()) < kFewest
                           ? NAN
                           : RobustSigmaOf(std::move(of_view_px)) / std::sqrt(6.0));
  return noise_px;
}

NoiseSums::NoiseSums(const AdjustOptions& options, std::vector<double> redundancies)
    : relative_noise_(options.relative_noise),
      redundancies_(std::move(redundancies)),
      huber_px_(options.huber_px),
      sums_(redundancies_.size()) {
  relative_noise_.resize(redundancies_.size(), 1);
}

void NoiseSums::Add(int view, const Eigen::Vector2d& residual_px) {
  sums_[view].Add(residual_px.norm() / relative_noise_[view], huber_px_);
}

void NoiseSums::AddOther(double residual_px) { others_.Add(std::abs(residual_px), 0); }

double NoiseSums::PooledOver_px(const std::vector<bool>& which) const {
  double squares_px2 = 0, redundancy = 0;
  for (std::size_t view = 0; view < sums_.size(); ++view) {
    if (!which[view] || sums_[view].count == 0) continue;
    const double one_px = relative_noise_[view] * sums_[view].Sigma_px(1);
    squares_px2 += one_px * one_px;
    redundancy += redundancies_[view];
  }
  return redundancy > 0 ? std::sqrt(squares_px2 / redundancy) : NAN;
}

bool NoiseSums::IsTold(int view) const {
  return redundancies_[view] >= kFewest &&
         redundancies_[view] >= kLeastShare * 2 * sums_[view].count;
}

std::vector<double> NoiseSums::NoiseOfViews_px() const {
  std::vector<bool> told(sums_.size()), untold(sums_.size());
  double untold_redundancy = 0;
  for (int view = 0; view < static_cast<int>(sums_.size()); ++view) {
    told[view] = IsTold(view);
    untold[view] = !told[view];
    if (untold[view]) untold_redundancy += redundancies_[view];
  }
  const double of_untold_px =
      untold_redundancy >= kFewest ? PooledOver_px(untold) : PooledNoise_px();
  std::vector<double> noise_px;
  for (std::size_t view = 0; view < sums_.size(); ++view)
    noise_px.push_back(told[view]
                           ? relative_noise_[view] * sums_[view].Sigma_px(redundancies_[view])
                           : of_untold_px);
  return noise_px;
}

double NoiseSums::PooledNoise_px() const {
  return PooledOver_px(std::vector<bool>(sums_.size(), true));
}

double NoiseSums::VarianceFactor_px2(int degrees_of_freedom) const {
  HuberSums all = others_;
  for (const HuberSums& sums : sums_) all += sums;
  const double sigma_px = all.Sigma_px(degrees_of_freedom);
  return sigma_px * sigma_px * all.mean_weight();
}

bool WeighViews(const std::vector<double>& noise_px, double pooled_px, AdjustOptions& options) {
  // Perfect corners, as tests make them, have no noise to be weighed by.
  constexpr double kLeast_px = 1e-3;
  constexpr double kStill = 0.01;
  const std::vector<double> before = options.relative_noise;
  options.relative_noise.assign(noise_px.size(), 1);
  if (!std::isfinite(pooled_px)) return before != options.relative_noise;
  double change = before.empty() ? 1 : 0;
  for (std::size_t view = 0; view < noise_px.size(); ++view) {
    double& relative = options.relative_noise[view];
    relative = std::max(kLeast_px, noise_px[view]) / std::max(kLeast_px, pooled_px);
    if (!before.empty()) change = std::max(change, std::abs(relative / before[view] - 1));
  }
  return change > kStill;
}

}  // namespace articap
