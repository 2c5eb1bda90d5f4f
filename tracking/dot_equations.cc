// SPDX-License-Identifier: MIT
#include "tracking/dot_equations.h"

#include <algorithm>
#include <cstring>

#if defined(__x86_64__) || defined(__i386__)
#define ARTICAP_X86 1
#endif

namespace articap {
namespace {

// Ten of the Jacobian, one of the residuals, and an empty one: products go by threes.
constexpr int kColumns = 12;
constexpr int kResidual = 10;
constexpr int kBlock = 3;

struct Task {
  int count = 0;  // a multiple of kLanes
  const float *x, *y, *value, *saturated, *present;
  float* columns;
  float* roots;
  DotEllipse ellipse;
  float contrast, background, slope_x, slope_y;
  float read_variance, gain;
  float inverse_scale;
  DotEquations::Weights weights;
};

struct Sums {
  float products[kColumns][kColumns];  // the upper triangle of blocks
  float believed, all;
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

void Run(SimdLevel level, const Task& task, Sums& sums) {
#ifdef ARTICAP_X86
  if (level == SimdLevel::kAvx2) {
    avx2::Run(task, sums);
    return;
  }
#endif
  (void)level;
  baseline::Run(task, sums);
}

}  // namespace

void DotPixels::Start(int most_pixels) {
  count_ = 0;
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
  ++count_;
}

void DotPixels::Finish() {
  for (int i = count_; i < num_padded(); ++i)
    x_[i] = y_[i] = value_[i] = saturated_[i] = present_[i] = 0;
}

void DotPixels::CopyBefore(const DotPixels& others, const Eigen::Vector2f& direction,
                           float limit_px) {
  Start(others.count_);
  for (int i = 0; i < others.count_; ++i)
    if (direction.dot(Eigen::Vector2f(others.x_[i], others.y_[i])) < limit_px)
      Add(others.x_[i], others.y_[i], others.value_[i], others.saturated_[i] != 0);
  Finish();
}

DotEquations::Normal DotEquations::At(const DotPixels& pixels, const DotModel& model,
                                      const PixelNoise& noise, Weights weights, double scale) {
  const int count = pixels.num_padded();
  if (columns_.size() < static_cast<std::size_t>(count) * kColumns) {
    columns_.resize(static_cast<std::size_t>(count) * kColumns);
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
  task.read_variance = static_cast<float>(noise.read_variance);
  task.gain = static_cast<float>(noise.gain);
  task.inverse_scale = static_cast<float>(1 / scale);
  task.weights = weights;
  Sums sums;
  Run(level_, task, sums);
  if (weights == Weights::kByLoss) disbelieved_ = sums.all > 0 ? 1 - sums.believed / sums.all : 1;
  Normal normal;
  for (int i = 0; i <= kResidual; ++i)
    for (int j = i; j <= kResidual; ++j)
      normal(i, j) = normal(j, i) = static_cast<double>(sums.products[i][j]);
  return normal;
}

}  // namespace articap
