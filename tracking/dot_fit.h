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
  // Root mean square of what the noise does not explain, over the contrast: of the pixels within
  // the edge and within its blur, and of all.
  double left = 0;
  double left_of_all = 0;
  // The part of the pixels within the edge, and within its blur, that the robust fit does not
  // believe, 0 to 1.
  double disbelieved = 0;
  int steps = 0;
};

enum class DotGround : std::uint8_t {
  kSupported,  // its slope and bend as far as the pixels support them
  kUneven,     // with both
};

// The maximum-likelihood fit of a blurred ellipse: weighted least squares by Levenberg's and
// Marquardt's method, from a start that is right to about a tenth of the diameter. Weights are the
// inverse variances at the model's values after the first step, so that noise does not choose its
// own weight; what the profile may be off is part of the variance. The background's slope, and its
// bend with it, are fitted where that lowers chi^2 by more than 12 and 16 times the misfit, as they
// cost up to a tenth of the centre's accuracy. Saturated pixels pull only while the model is below
// them.
//
// The covariance is the inverse of the Fisher information with all other parameters free, times the
// misfit, of all pixels or of the dot's own, where that is above 1. Nothing where no ellipse comes
// out. One object a thread: it keeps its scratch.
class DotFitter {
 public:
  explicit DotFitter(SimdLevel level = BestSimdLevel()) : equations_(level) {}

  // An even dot. Nothing too where it leaves more than most_left (DotFit::left).
  std::optional<DotFit> Fit(const DotPixels& pixels, const DotModel& start, const PixelNoise& noise,
                            DotGround ground = DotGround::kSupported, double most_left = 1);

  // From the fit of an even dot on, with the dot's own shade, which costs a third of the centre's
  // accuracy. Nothing too where more than three tenths of the dot's pixels are saturated, as these
  // tell no shade.
  std::optional<DotFit> FitShaded(const DotPixels& pixels, const DotModel& start,
                                  const PixelNoise& noise);

  // The same from a fit, while pixels that do not follow the model count for less and less (Geman
  // and McClure's loss): for dots of which something is hidden. Residuals of `scale`, a part of the
  // contrast, count for a quarter. `widening`: of the loss in the first step, where it is nearly
  // convex; 1 for a start to be believed.
  std::optional<DotFit> FitRobustly(const DotPixels& pixels, const DotModel& start,
                                    const PixelNoise& noise, double scale, double widening);

 private:
  static constexpr int kNumParameters = DotEquations::kNumParameters;
  static constexpr int kEven = DotEquations::kNumEven;
  using Parameters = Eigen::Matrix<double, kNumParameters, 1>;
  using Weights = DotEquations::Weights;
  struct State {
    Parameters at;
    int free = kEven;  // so many of the parameters, the others being zero
    DotEquations::Normal normal;
    DotEquations::Own own;
  };

  void Start(const DotPixels& pixels, const DotModel& start, const PixelNoise& noise, State& state);
  void Evaluate(Weights weights, State& state, double scale = 1);
  // kByModel: weights are of the model after the first step.
  void Minimise(Weights weights, double arrived2, int most_steps, State& state);
  // The same from a state that has been evaluated; weighs: with other weights after the first step.
  void Descend(bool weighs, double arrived2, int most_steps, State& state);
  // Frees slope and bend as far as the pixels support them.
  void Extend(int most_steps, State& state);
  // How many parameters that is.
  int SupportedBy(const State& all, int free) const;
  std::optional<DotFit> Conclude(const State& state) const;

  DotEquations equations_;
  const DotPixels* pixels_ = nullptr;  // during a fit
  PixelNoise noise_;                   // with what the profile may be off
  double model_variance_ = 0;          // which is this
  double largest_px_ = 0;              // that the pixels can show
  int steps_ = 0;
};

}  // namespace articap
