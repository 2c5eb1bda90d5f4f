// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/network.h"
#include "calib/robust.h"

namespace articap {

// What the residuals of an adjustment say of the noise of each view, by variance components: the
// squares of its residuals over those of them that the parameters do not take up (its redundancy).
// Adjusting again with these weights, until they stand still, gives the restricted maximum
// likelihood. W. Förstner, "Ein Verfahren zur Schätzung von Varianz- und Kovarianzkomponenten",
// Allgemeine Vermessungs-Nachrichten 86, 1979.
class NoiseSums {
 public:
  // `options` as adjusted with, `redundancies` of each view (ArrowCovariance).
  NoiseSums(const AdjustOptions& options, std::vector<double> redundancies);

  void Add(int view, const Eigen::Vector2d& residual_px);
  // A residual that is of no view, of the usual view's unit, without Huber's loss: it counts in the
  // variance factor alone.
  void AddOther(double residual_px);

  // Standard deviation of one coordinate in each view. Views whose residuals hardly tell it, as
  // they are few, or as the view decides most of what it is compared with, are taken together; NaN
  // where there are no degrees of freedom.
  std::vector<double> NoiseOfViews_px() const;
  // Of all views together: the root of the mean of their variances, by redundancy.
  double PooledNoise_px() const;
  // What the inverse of J'J of the weighted residuals is to be multiplied by (HuberSums).
  double VarianceFactor_px2(int degrees_of_freedom) const;

 private:
  // Whether a view's residuals tell its own noise.
  bool IsTold(int view) const;
  double PooledOver_px(const std::vector<bool>& views) const;

  std::vector<double> relative_noise_;
  std::vector<double> redundancies_;
  double huber_px_;
  std::vector<HuberSums> sums_;  // of residuals over the relative noise, one a view
  HuberSums others_;
};

// The noise of the corners of each view against their neighbours on the board, robustly: what is
// left of residuals once they may differ linearly along its rows and columns (second differences,
// of variance 6). Where something does not stand as the adjustment takes it to, residuals run the
// same way for parts of the board, and are larger than this. NaN of too few corners.
std::vector<double> LocalNoiseOfViews_px(const AdjustedNetwork& adjusted);

// Weighs the views of the next adjustment by the noise that the last one found. Whether that
// changes weights, by more than a hundredth.
bool WeighViews(const std::vector<double>& noise_px, double pooled_px, AdjustOptions& options);

}  // namespace articap
