// SPDX-License-Identifier: MIT
#include "tracking/dot_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace articap {
namespace {

constexpr int kLanes = Lanes::SizeAtCompileTime;
enum Parameter { kX, kY, kXx, kXy, kYy, kBlur, kContrast, kBackground, kSlopeX, kSlopeY };

// A pixel's own square has an SD of 1/sqrt(12) px, which no lens undercuts.
constexpr double kLeastBlur_px = 0.289;
constexpr int kMostSteps = 8;
constexpr int kMostRobustSteps = 2;  // at each width of the loss

using Parameters = Eigen::Matrix<double, 10, 1>;

Parameters Pack(const DotModel& model) {
  const DotEllipse& dot = model.ellipse;
  Parameters at;
  at << dot.center_px.cast<double>(), dot.xx, dot.xy, dot.yy, dot.blur_px, model.contrast,
      model.background, model.slope_per_px;
  return at;
}

DotModel Unpack(const Parameters& at) {
  const Eigen::Matrix<float, 10, 1> values = at.cast<float>();
  return {{values.head<2>(), values[kXx], values[kXy], values[kYy], values[kBlur]},
          at[kContrast],
          at[kBackground],
          at.tail<2>()};
}

// The model at eight pixels.
Lanes ValueAt(const DotModel& model, const Lanes& inside, const Lanes& x, const Lanes& y) {
  const Eigen::Vector2f slope = model.slope_per_px.cast<float>();
  return static_cast<float>(model.background) + slope.x() * x + slope.y() * y +
         static_cast<float>(model.contrast) * inside;
}

// What is missing to the measured light; where that is saturated, too much is right.
Lanes ResidualAt(const DotPixels& pixels, int first, const Lanes& model) {
  const Lanes residual = pixels.value(first) - model;
  return residual.max(0.0f) + (1 - pixels.saturated(first)) * residual.min(0.0f);
}

// Steps that would leave what a dot can be end at its border.
void KeepPossible(double largest_px, Parameters& at) {
  at[kXx] = std::clamp(at[kXx], 1 / largest_px, 4.0);
  at[kYy] = std::clamp(at[kYy], 1 / largest_px, 4.0);
  at[kXy] = std::clamp(at[kXy], -4.0, 4.0);
  at[kBlur] = std::clamp(at[kBlur], kLeastBlur_px, largest_px);
  at[kX] = std::clamp(at[kX], -largest_px, largest_px);
  at[kY] = std::clamp(at[kY], -largest_px, largest_px);
}

// By how much chi^2 would fall if the parameters behind the first `held_from` were free too.
double GainOfFreeing(const Eigen::Matrix<double, 11, 11>& normal, int held_from) {
  const int added = 10 - held_from;
  const Eigen::MatrixXd across = normal.block(0, held_from, held_from, added);
  const Eigen::MatrixXd schur =
      normal.block(held_from, held_from, added, added) -
      across.transpose() * normal.topLeftCorner(held_from, held_from).ldlt().solve(across);
  const Eigen::VectorXd gradient = normal.col(10).segment(held_from, added);
  return gradient.dot(schur.ldlt().solve(gradient));
}

Eigen::VectorXd DampedStep(const Eigen::Matrix<double, 11, 11>& normal, int free, double damping) {
  Eigen::MatrixXd damped = normal.topLeftCorner(free, free);
  damped.diagonal() *= 1 + damping;
  damped.diagonal().array() += 1e-12 * damped.diagonal().maxCoeff();
  return damped.ldlt().solve(normal.col(10).head(free));
}

// What the equations will be after a small step.
void Advance(const Eigen::VectorXd& step, Eigen::Matrix<double, 11, 11>& normal) {
  const auto gradient = normal.col(10).head(step.size());
  const double fall = step.dot(gradient);
  normal.col(10).head<10>() -= normal.topLeftCorner(10, step.size()) * step;
  normal(10, 10) -= fall;
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

int DotPixels::num_padded() const { return (count_ + kLanes - 1) / kLanes * kLanes; }

std::optional<DotFit> DotFitter::Fit(const DotPixels& pixels, const DotModel& start,
                                     const PixelNoise& noise) {
  noise_ = noise;
  largest_px_ = std::sqrt(pixels.count());
  steps_ = 0;
  Parameters at = Pack(start);
  Normal normal;
  const int free = MinimiseAll(pixels, true, at, normal);
  return Conclude(pixels, at, normal, free);
}

std::optional<DotFit> DotFitter::FitRobustly(const DotPixels& pixels, const DotFit& start,
                                             const PixelNoise& noise, double scale) {
  noise_ = noise;
  largest_px_ = std::sqrt(pixels.count());
  steps_ = 0;
  Parameters at = Pack(start.model);
  Normal normal;
  int free = kWithoutSlope;
  double disbelieved = 0;
  // From a wide loss, which is nearly convex, to the one wanted.
  for (const double widened : {6.0, 3.0, 1.5, 1.0, 1.0}) {
    disbelieved = Downweigh(pixels, at, widened * scale);
    free = MinimiseAll(pixels, false, at, normal);
  }
  std::optional<DotFit> fit = Conclude(pixels, at, normal, free);
  if (fit) fit->disbelieved = disbelieved;
  return fit;
}

DotFitter::Normal DotFitter::Linearise(const DotPixels& pixels, const Parameters& at, bool weigh) {
  const DotModel model = Unpack(at);
  const int num_rows = pixels.num_padded();
  // One more than there are, and empty: products of matrices go by fours.
  constexpr int kColumns = kNumParameters + 2;
  rows_.resize(static_cast<std::size_t>(num_rows) * kColumns);
  roots_.resize(num_rows);
  const auto contrast = static_cast<float>(model.contrast);
  const auto read = static_cast<float>(noise_.read_variance);
  const auto gain = static_cast<float>(noise_.gain);
  DotProfile profile;
  for (int first = 0; first < num_rows; first += kLanes) {
    const Lanes x = pixels.x(first), y = pixels.y(first);
    ProfileAt(model.ellipse, x, y, profile);
    const Lanes value = ValueAt(model, profile.inside, x, y);
    const Lanes residual = ResidualAt(pixels, first, value);
    Eigen::Map<Lanes> weight_root(&roots_[first]);
    if (weigh)
      weight_root = pixels.present(first) / (read + gain * value.max(0.0f).min(1.0f)).sqrt();
    // Saturated pixels that the model is above say nothing.
    const Lanes root =
        weight_root * (1 - pixels.saturated(first) * (1 - (1e30f * residual).min(1.0f)));
    const auto column = [&](int index) {
      return Eigen::Map<Lanes>(&rows_[static_cast<std::size_t>(index) * num_rows + first]);
    };
    const Lanes steepness = contrast * root;
    for (int i = 0; i <= kBlur; ++i) column(i) = steepness * profile.by[i];
    column(kContrast) = root * profile.inside;
    column(kBackground) = root;
    column(kSlopeX) = root * x;
    column(kSlopeY) = root * y;
    column(kNumParameters) = root * residual;
    column(kNumParameters + 1).setZero();
  }
  const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, kColumns>> rows(rows_.data(),
                                                                              num_rows, kColumns);
  Eigen::Matrix<float, kColumns, kColumns> products;
  products.leftCols<4>().noalias() = rows.transpose() * rows.leftCols<4>();
  products.block<8, 4>(4, 4).noalias() = rows.rightCols<8>().transpose() * rows.middleCols<4>(4);
  products.block<4, 4>(8, 8).noalias() = rows.rightCols<4>().transpose() * rows.rightCols<4>();
  return products.topLeftCorner<kNumParameters + 1, kNumParameters + 1>()
      .cast<double>()
      .selfadjointView<Eigen::Lower>();
}

double DotFitter::Downweigh(const DotPixels& pixels, const Parameters& at, double scale) {
  Linearise(pixels, at, true);
  const DotModel model = Unpack(at);
  const auto inverse_scale = static_cast<float>(1 / (scale * std::abs(model.contrast)));
  DotProfile profile;
  float belief = 0, all = 0;
  for (int first = 0; first < pixels.num_padded(); first += kLanes) {
    const Lanes x = pixels.x(first), y = pixels.y(first);
    ProfileAt(model.ellipse, x, y, profile);
    const Lanes residual =
        inverse_scale * ResidualAt(pixels, first, ValueAt(model, profile.inside, x, y));
    // Geman and McClure: the square root of the weight 1 / (1 + r^2)^2.
    const Lanes root = 1 / (1 + residual * residual);
    const Lanes counts = pixels.present(first) * (10 * profile.inside).min(1.0f);
    belief += (counts * root * root).sum();
    all += counts.sum();
    Eigen::Map<Lanes> weight_root(&roots_[first]);
    weight_root *= root;
  }
  return all > 0 ? 1 - belief / all : 1;
}

DotFitter::Normal DotFitter::Minimise(const DotPixels& pixels, int free, bool weigh,
                                      Parameters& at) {
  Normal normal = Linearise(pixels, at, weigh);
  const int most_steps = weigh ? kMostSteps : kMostRobustSteps;
  double damping = 1e-3;
  for (int tried = 0; tried < most_steps; ++tried, ++steps_) {
    const Eigen::VectorXd step = DampedStep(normal, free, damping);
    Parameters next = at;
    next.head(free) += step;
    KeepPossible(largest_px_, next);
    const double chi2 = normal(kNumParameters, kNumParameters);
    // In units of the standard deviations that the misfit makes likely.
    constexpr double kArrived2 = 0.01;
    const double moved2 = step.dot(normal.topLeftCorner(free, free) * step);
    if (!(moved2 > kArrived2 * std::max(1.0, chi2 / pixels.count()))) {
      at = next;
      Advance(step, normal);
      break;
    }
    const Normal at_next = Linearise(pixels, next, weigh);
    // Other weights change chi^2 a little.
    if (at_next(kNumParameters, kNumParameters) <= (weigh ? 1.5 : 1.0) * chi2) {
      at = next;
      normal = at_next;
      damping *= 0.1;
      weigh = false;
    } else {
      damping *= 10;
      if (damping > 1e8) break;
    }
  }
  return normal;
}

int DotFitter::MinimiseAll(const DotPixels& pixels, bool weigh, Parameters& at, Normal& normal) {
  const int free = at.tail<2>().isZero(0) ? kWithoutSlope : kNumParameters;
  normal = Minimise(pixels, free, weigh, at);
  if (free == kNumParameters) return free;
  constexpr double kSupported = 12;
  const double misfit = normal(kNumParameters, kNumParameters) / pixels.count();
  if (GainOfFreeing(normal, kWithoutSlope) <= kSupported * std::max(1.0, misfit)) return free;
  normal = Minimise(pixels, kNumParameters, false, at);
  return kNumParameters;
}

std::optional<DotFit> DotFitter::Conclude(const DotPixels& pixels, const Parameters& at,
                                          const Normal& normal, int free) const {
  const int freedom = pixels.count() - free;
  if (freedom < 1 || !at.allFinite() || at[kContrast] <= 0) return std::nullopt;
  DotFit fit;
  fit.model = Unpack(at);
  fit.steps = steps_;
  fit.misfit = normal(kNumParameters, kNumParameters) / freedom;
  const double unexplained = std::max(0.0, fit.misfit - 1) * freedom;
  fit.left = std::sqrt(unexplained / normal(kBackground, kBackground)) / at[kContrast];
  const Eigen::MatrixXd covariance =
      normal.topLeftCorner(free, free).ldlt().solve(Eigen::MatrixXd::Identity(free, 2));
  fit.covariance_px2 = std::max(1.0, fit.misfit) * covariance.topRows<2>();
  if (!fit.covariance_px2.allFinite() || fit.covariance_px2.diagonal().minCoeff() <= 0)
    return std::nullopt;
  return fit;
}

}  // namespace articap
