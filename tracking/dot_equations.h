// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tracking/dot_profile.h"
#include "tracking/pixel_noise.h"
#include "tracking/simd_level.h"

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

  // Those of others that lie less than `limit_px` along a direction.
  void CopyBefore(const DotPixels& others, const Eigen::Vector2f& direction, float limit_px);

  int count() const { return count_; }
  int num_padded() const { return (count_ + kLanes - 1) / kLanes * kLanes; }
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* value() const { return value_.data(); }
  const float* saturated() const { return saturated_.data(); }  // 1, else 0
  const float* present() const { return present_.data(); }      // 0 for what only fills up, else 1

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

// The normal equations of a dot's least squares, of the parameters centre x, y, xx, xy, yy, blur,
// contrast, background, slope x, y, and of the residuals.
class DotEquations {
 public:
  static constexpr int kNumParameters = 10;
  // J^T W J, J^T W r and r^T W r, J being the Jacobian and r what is measured less the model.
  using Normal = Eigen::Matrix<double, kNumParameters + 1, kNumParameters + 1>;

  enum class Weights : std::uint8_t {
    kKept,     // as they were the last time
    kByModel,  // the inverse variances at the values of the model
    kByLoss,   // times what Geman and McClure's loss believes: (1 + (r / scale)^2)^-2
  };

  explicit DotEquations(SimdLevel level = BestSimdLevel()) : level_(level) {}

  // scale: of the loss. Saturated pixels that the model is above say nothing.
  Normal At(const DotPixels& pixels, const DotModel& model, const PixelNoise& noise,
            Weights weights, double scale = 1);
  // After kByLoss: the part of the pixels within the edge, and within its blur, that the loss does
  // not believe, 0 to 1.
  double disbelieved() const { return disbelieved_; }

 private:
  SimdLevel level_;
  std::vector<float> columns_;  // weighted, eight pixels of each in turn
  std::vector<float> roots_;    // of the weights
  double disbelieved_ = 0;
};

}  // namespace articap
