// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tracking/dot_equations.h"
#include "tracking/pixel_noise.h"

namespace articap {

struct DotFit {
  DotModel model;
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();  // of the centre
  double misfit = 1;  // mean square of the residuals over their variances
  double left = 0;    // root mean square of what the noise does not explain, over the contrast
  // The part of the pixels within the edge, and within its blur, that the robust fit does not
  // believe, 0 to 1.
  double disbelieved = 0;
  int steps = 0;
};

// The maximum-likelihood fit of a blurred ellipse: weighted least squares by Levenberg's and
// Marquardt's method, from a start that is right to about a tenth of the diameter. Weights are the
// inverse variances at the model's values after the first step, so that noise does not choose its
// own weight. The background's slope is fitted where that lowers chi^2 by more than 12, as it costs
// up to a tenth of the centre's accuracy. Saturated pixels pull only while the model is below them.
//
// The covariance is the inverse of the Fisher information with all other parameters free, times the
// misfit where that is above 1. Nothing where no ellipse comes out. One object a thread: it keeps
// its scratch.
class DotFitter {
 public:
  explicit DotFitter(SimdLevel level = BestSimdLevel()) : equations_(level) {}

  std::optional<DotFit> Fit(const DotPixels& pixels, const DotModel& start,
                            const PixelNoise& noise);

  // The same from a fit, while pixels that do not follow the model count for less and less (Geman
  // and McClure's loss): for dots of which something is hidden. Residuals of `scale`, a part of the
  // contrast, count for a quarter. `widening`: of the loss in the first step, where it is nearly
  // convex; 1 for a start to be believed.
  std::optional<DotFit> FitRobustly(const DotPixels& pixels, const DotModel& start,
                                    const PixelNoise& noise, double scale, double widening);

 private:
  static constexpr int kNumParameters = DotEquations::kNumParameters;
  static constexpr int kWithoutSlope = 8;
  using Parameters = Eigen::Matrix<double, kNumParameters, 1>;
  using Normal = DotEquations::Normal;
  using Weights = DotEquations::Weights;

  Normal At(const Parameters& parameters, Weights weights, double scale = 1);
  // Over the first `free` parameters. kByModel: weights are of the model after the first step.
  Normal Minimise(int free, Weights weights, Parameters& at);
  // Adds the slope where it is there; returns how many parameters are free.
  int MinimiseAll(Weights weights, Parameters& at, Normal& normal);
  std::optional<DotFit> Conclude(const Parameters& at, const Normal& normal, int free) const;

  DotEquations equations_;
  const DotPixels* pixels_ = nullptr;  // during a fit
  PixelNoise noise_;
  double largest_px_ = 0;  // that the pixels can show
  int steps_ = 0;
};

}  // namespace articap
