// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tracking/dot_profile.h"
#include "tracking/pixel_noise.h"

namespace articap {

// The pixels that a dot is fitted to. Values are linear in the light, parts of the full range, the
// dot brighter than what surrounds it.
class DotPixels {
 public:
  // Forgets what there was, and makes room.
  void Start(int most_pixels);
  // saturated: as bright as the file can say; the light is this, or more.
  void Add(float x_px, float y_px, float value, bool saturated);
  // Fills up to whole lanes, with pixels that count for nothing.
  void Finish();

  int count() const { return count_; }
  int num_padded() const;
  Lanes x(int first) const { return Eigen::Map<const Lanes>(&x_[first]); }
  Lanes y(int first) const { return Eigen::Map<const Lanes>(&y_[first]); }
  Lanes value(int first) const { return Eigen::Map<const Lanes>(&value_[first]); }
  // 1 for saturated ones, else 0.
  Lanes saturated(int first) const { return Eigen::Map<const Lanes>(&saturated_[first]); }
  // 0 for what only fills up, else 1.
  Lanes present(int first) const { return Eigen::Map<const Lanes>(&present_[first]); }

 private:
  int count_ = 0;
  std::vector<float> x_, y_, value_, saturated_, present_;
};

// What is fitted: I(p) = background + slope . p + contrast * profile(p).
struct DotModel {
  DotEllipse ellipse;
  double contrast = 0;
  double background = 0;  // at the origin of the pixels' coordinates
  Eigen::Vector2d slope_per_px = Eigen::Vector2d::Zero();
};

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
  std::optional<DotFit> Fit(const DotPixels& pixels, const DotModel& start,
                            const PixelNoise& noise);

  // The same from a fit, while pixels that do not follow the model count for less and less (Geman
  // and McClure's loss): for dots of which something is hidden. Residuals of `scale`, a part of the
  // contrast, count for a quarter.
  std::optional<DotFit> FitRobustly(const DotPixels& pixels, const DotFit& start,
                                    const PixelNoise& noise, double scale);

 private:
  static constexpr int kNumParameters = 10;  // six of the ellipse, contrast, background, slope
  static constexpr int kWithoutSlope = 8;
  using Parameters = Eigen::Matrix<double, kNumParameters, 1>;
  // J^T W J, J^T W r and r^T W r, J being the Jacobian and r the residuals.
  using Normal = Eigen::Matrix<double, kNumParameters + 1, kNumParameters + 1>;

  // Sets the weights too if they shall be those of the model there.
  Normal Linearise(const DotPixels& pixels, const Parameters& at, bool weigh);
  // Times what the loss believes of each pixel; returns the part of the dot that it does not.
  double Downweigh(const DotPixels& pixels, const Parameters& at, double scale);
  // Over the first `free` parameters. weigh: by the model after the first step, else as it is.
  Normal Minimise(const DotPixels& pixels, int free, bool weigh, Parameters& at);
  // Adds the slope where it is there; returns how many parameters are free.
  int MinimiseAll(const DotPixels& pixels, bool weigh, Parameters& at, Normal& normal);
  std::optional<DotFit> Conclude(const DotPixels& pixels, const Parameters& at,
                                 const Normal& normal, int free) const;

  std::vector<float> rows_;   // Jacobian and residuals times the root of the weights, by columns
  std::vector<float> roots_;  // of the weights
  PixelNoise noise_;
  double largest_px_ = 0;  // that the pixels can show
  int steps_ = 0;
};

}  // namespace articap
