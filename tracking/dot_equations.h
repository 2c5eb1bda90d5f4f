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
  // Those of others at p with (p - center)^T inverse_shape (p - center) <= 1.
  void CopyWithin(const DotPixels& others, const Eigen::Vector2f& center_px,
                  const Eigen::Matrix2f& inverse_shape);

  int count() const { return count_; }
  int num_saturated() const { return num_saturated_; }
  int num_padded() const { return (count_ + kLanes - 1) / kLanes * kLanes; }
  const float* x() const { return x_.data(); }
  const float* y() const { return y_.data(); }
  const float* value() const { return value_.data(); }
  const float* saturated() const { return saturated_.data(); }  // 1, else 0
  const float* present() const { return present_.data(); }      // 0 for what only fills up, else 1

 private:
  template <class Wanted>
  void CopyIf(const DotPixels& others, const Wanted& wanted);

  int count_ = 0;
  int num_saturated_ = 0;
  std::vector<float> x_, y_, value_, saturated_, present_;
};

// What is fitted: I(p) = background + slope . p + bend . (x^2 - y^2, 2 x y)
//                        + profile(p) * (contrast + shade . (u.x, u.y, h - 2/3)),
// with u = L (p - centre), which maps the ellipse to the unit circle (dot_profile.h), and
// h = sqrt(1 - |u|^2). (u.x, u.y, h) is the normal of a ball that the ellipse is the outline of:
// the shade is what a matt ball has in the light of a lamp (Lambert's law), and for a disc that the
// light falls off across. The mean of h over the ellipse is 2/3.
struct DotModel {
  DotEllipse ellipse;
  double contrast = 0;
  double background = 0;  // at the origin of the pixels' coordinates
  Eigen::Vector2d slope_per_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d bend_per_px2 = Eigen::Vector2d::Zero();
  Eigen::Vector3d shade = Eigen::Vector3d::Zero();
};

// The normal equations of a dot's least squares, of the parameters centre x, y, xx, xy, yy, blur,
// contrast, background, slope x, y, bend 1, 2, shade x, y, h, and of the residuals.
class DotEquations {
 public:
  static constexpr int kNumEven = 8;     // the parameters of an even dot on even ground
  static constexpr int kNumGround = 12;  // on ground with slope and bend
  static constexpr int kNumParameters = 15;
  // J^T W J, J^T W r and r^T W r, J being the Jacobian and r what is measured less the model.
  using Normal = Eigen::Matrix<double, kNumParameters + 1, kNumParameters + 1>;

  enum class Weights : std::uint8_t {
    kKept,     // as they were the last time
    kByModel,  // the inverse variances at the values of the model
    kByLoss,   // times what Geman and McClure's loss believes: (1 + (r / scale)^2)^-2
  };

  // Which rows and columns are worked out; the others are zero.
  enum class Terms : std::uint8_t {
    kEven,    // of the first kNumEven parameters, and only where the others are zero
    kGround,  // of the first kNumGround, likewise
    kAll,
  };

  explicit DotEquations(SimdLevel level = BestSimdLevel()) : level_(level) {}

  // scale: of the loss. Saturated pixels that the model is above say nothing.
  Normal At(const DotPixels& pixels, const DotModel& model, const PixelNoise& noise, Terms terms,
            Weights weights, double scale = 1);
  // Of the last At(), over the pixels within the edge, and within its blur: their number, the sum
  // of their weights, and that of their weighted squared residuals.
  struct Own {
    double count = 0;
    double weight = 0;
    double chi2 = 0;
  };
  const Own& own() const { return own_; }
  // After kByLoss: the part of these pixels that the loss does not believe, 0 to 1.
  double disbelieved() const { return disbelieved_; }

 private:
  SimdLevel level_;
  std::vector<float> columns_;  // weighted, eight pixels of each in turn
  std::vector<float> roots_;    // of the weights
  Own own_;
  double disbelieved_ = 0;
};

}  // namespace articap
