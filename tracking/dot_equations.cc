// SPDX-License-Identifier: MIT
#include "tracking/dot_equations.h"

#include <algorithm>
#include <cstring>

#if defined(__x86_64__) || defined(__i386__)
#define ARTICAP_X86 1
#endif

namespace articap {
namespace {

// Products go by threes: eight columns of the Jacobian and one of the residuals, or twelve or
// fifteen and one that is left over.
constexpr int kBlock = 3;
constexpr int kEvenColumns = DotEquations::kNumEven + 1;
constexpr int kGroundColumns = DotEquations::kNumGround + 1;
constexpr int kAllColumns = DotEquations::kNumParameters + 1;
static_assert(kEvenColumns % kBlock == 0 && kGroundColumns % kBlock == 1 &&
              kAllColumns % kBlock == 1);

struct Task {
  int count = 0;  // a multiple of kLanes
  const float *x, *y, *value, *saturated, *present;
  float* columns;
  float* roots;
  DotEllipse ellipse;
  float contrast, background, slope_x, slope_y;
  float bend_1, bend_2;
  float shade_x, shade_y, shade_h;
  float read_variance, gain;
  float inverse_scale;
  DotEquations::Weights weights;
};

struct Sums {
  float products[kAllColumns][kAllColumns];  // the upper triangle of blocks
  // Over the dot's own pixels.
  float count, believed, weight, chi2;
};

namespace baseline {
#include "tracking/dot_equations_kernel.inc"
}  // namespace baseline

#ifdef ARTICAP_X86
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#include "tracking/dot_equations_kernel.inc"
}  // namespace avx2
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

template <int kColumns>
void Run(SimdLevel level, const Task& task, Sums& sums) {
#ifdef ARTICAP_X86
  if (level == SimdLevel::kAvx2) {
    avx2::Run<kColumns>(task, sums);
    return;
  }
#endif
  (void)level;
  baseline::Run<kColumns>(task, sums);
}

}  // namespace

void DotPixels::Start(int most_pixels) {
  count_ = 0;
  num_saturated_ = 0;
  const std::size_t room = (most_pixels + kLanes - 1) / kLanes * kLanes;
  for (std::vector<float>* values : {&x_, &y_, &value_, &saturated_, &present_})
    if (values->size() < room) values->resize(room);
}

void DotPixels::Add(float x_px, float y_px, float value, bool saturated) {
  x_[count_] = x_px;
  y_[count_] = y_px;
  value_[count_] = value;
  saturated_[count_] = saturated ? 1.0f : 0.0f;
  present_[count_] = 1;
  num_saturated_ += saturated;
  ++count_;
}

void DotPixels::Finish() {
  for (int i = count_; i < num_padded(); ++i)
    x_[i] = y_[i] = value_[i] = saturated_[i] = present_[i] = 0;
}

template <class Wanted>
void DotPixels::CopyIf(const DotPixels& others, const Wanted& wanted) {
  Start(others.count_);
  for (int i = 0; i < others.count_; ++i)
    if (wanted(Eigen::Vector2f(others.x_[i], others.y_[i])))
      Add(others.x_[i], others.y_[i], others.value_[i], others.saturated_[i] != 0);
  Finish();
}

void DotPixels::CopyBefore(const DotPixels& others, const Eigen::Vector2f& direction,
                           float limit_px) {
  CopyIf(others, [&](const Eigen::Vector2f& at) { return direction.dot(at) < limit_px; });
}

void DotPixels::CopyWithin(const DotPixels& others, const Eigen::Vector2f& center_px,
                           const Eigen::Matrix2f& inverse_shape) {
  CopyIf(others, [&](const Eigen::Vector2f& at) {
    const Eigen::Vector2f away = at - center_px;
    return away.dot(inverse_shape * away) <= 1;
  });
}

DotEquations::Normal DotEquations::At(const DotPixels& pixels, const DotModel& model,
                                      const PixelNoise& noise, Terms terms, Weights weights,
                                      double scale) {
  const int count = pixels.num_padded();
  if (roots_.size() < static_cast<std::size_t>(count)) {
    columns_.resize(static_cast<std::size_t>(count) * kAllColumns);
    roots_.resize(count);
  }
  Task task;
  task.count = count;
  task.x = pixels.x();
  task.y = pixels.y();
  task.value = pixels.value();
  task.saturated = pixels.saturated();
  task.present = pixels.present();
  task.columns = columns_.data();
  task.roots = roots_.data();
  task.ellipse = model.ellipse;
  task.contrast = static_cast<float>(model.contrast);
  task.background = static_cast<float>(model.background);
  task.slope_x = static_cast<float>(model.slope_per_px.x());
  task.slope_y = static_cast<float>(model.slope_per_px.y());
  task.bend_1 = static_cast<float>(model.bend_per_px2.x());
  task.bend_2 = static_cast<float>(model.bend_per_px2.y());
  task.shade_x = static_cast<float>(model.shade.x());
  task.shade_y = static_cast<float>(model.shade.y());
  task.shade_h = static_cast<float>(model.shade.z());
  task.read_variance = static_cast<float>(noise.read_variance);
  task.gain = static_cast<float>(noise.gain);
  task.inverse_scale = static_cast<float>(1 / scale);
  task.weights = weights;
  Sums sums;
  int num_columns = kNumParameters;
  if (terms == Terms::kEven) {
    num_columns = kNumEven;
    Run<kEvenColumns>(level_, task, sums);
  } else if (terms == Terms::kGround) {
    num_columns = kNumGround;
    Run<kGroundColumns>(level_, task, sums);
  } else {
    Run<kAllColumns>(level_, task, sums);
  }
  own_ = {sums.count, sums.weight, sums.chi2};
  if (weights == Weights::kByLoss)
    disbelieved_ = sums.count > 0 ? 1 - sums.believed / sums.count : 1;
  Normal normal = Normal::Zero();
  // The residuals' column is the one behind the parameters'.
  const auto place = [&](int column) { return column < num_columns ? column : kNumParameters; };
  for (int i = 0; i <= num_columns; ++i)
    for (int j = i; j <= num_columns; ++j)
      normal(place(i), place(j)) = normal(place(j), place(i)) =
          static_cast<double>(sums.products[i][j]);
  return normal;
}

}  // namespace articap
