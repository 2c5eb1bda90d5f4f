// SPDX-License-Identifier: MIT
#include "tracking/dot_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace articap {
namespace {

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

std::optional<DotFit> DotFitter::Fit(const DotPixels& pixels, const DotModel& start,
                                     const PixelNoise& noise) {
  pixels_ = &pixels;
  noise_ = noise;
  largest_px_ = std::sqrt(pixels.count());
  steps_ = 0;
  Parameters at = Pack(start);
  Normal normal;
  const int free = MinimiseAll(Weights::kByModel, at, normal);
  return Conclude(at, normal, free);
}

std::optional<DotFit> DotFitter::FitRobustly(const DotPixels& pixels, const DotModel& start,
                                             const PixelNoise& noise, double scale,
                                             double widening) {
  pixels_ = &pixels;
  noise_ = noise;
  largest_px_ = std::sqrt(pixels.count());
  steps_ = 0;
  Parameters at = Pack(start);
  Normal normal;
  int free = kWithoutSlope;
  constexpr int kPasses = 5;
  for (int pass = 0; pass < kPasses; ++pass, widening = std::max(1.0, widening / 2)) {
    At(at, Weights::kByLoss, widening * scale * at[kContrast]);
    free = MinimiseAll(Weights::kKept, at, normal);
  }
  std::optional<DotFit> fit = Conclude(at, normal, free);
  if (fit) fit->disbelieved = equations_.disbelieved();
  return fit;
}

DotFitter::Normal DotFitter::At(const Parameters& parameters, Weights weights, double scale) {
  return equations_.At(*pixels_, Unpack(parameters), noise_, weights, scale);
}

DotFitter::Normal DotFitter::Minimise(int free, Weights weights, Parameters& at) {
  Normal normal = At(at, weights);
  bool weighs = weights == Weights::kByModel;
  const int most_steps = weighs ? kMostSteps : kMostRobustSteps;
  double damping = 1e-3;
  for (int tried = 0; tried < most_steps; ++tried, ++steps_) {
    const Eigen::VectorXd step = DampedStep(normal, free, damping);
    Parameters next = at;
    next.head(free) += step;
    KeepPossible(largest_px_, next);
    const double chi2 = normal(kNumParameters, kNumParameters);
    // In units of the standard deviations that the misfit makes likely.
    constexpr double kArrived2 = 0.02;
    const double moved2 = step.dot(normal.topLeftCorner(free, free) * step);
    if (!(moved2 > kArrived2 * std::max(1.0, chi2 / pixels_->count()))) {
      at = next;
      Advance(step, normal);
      break;
    }
    const Normal at_next = At(next, weighs ? Weights::kByModel : Weights::kKept);
    // Other weights change chi^2 a little.
    if (at_next(kNumParameters, kNumParameters) <= (weighs ? 1.5 : 1.0) * chi2) {
      at = next;
      normal = at_next;
      damping *= 0.1;
      weighs = false;
    } else {
      damping *= 10;
      if (damping > 1e8) break;
    }
  }
  return normal;
}

int DotFitter::MinimiseAll(Weights weights, Parameters& at, Normal& normal) {
  const int free = at.tail<2>().isZero(0) ? kWithoutSlope : kNumParameters;
  normal = Minimise(free, weights, at);
  if (free == kNumParameters) return free;
  constexpr double kSupported = 12;
  const double misfit = normal(kNumParameters, kNumParameters) / pixels_->count();
  if (GainOfFreeing(normal, kWithoutSlope) <= kSupported * std::max(1.0, misfit)) return free;
  normal = Minimise(kNumParameters, Weights::kKept, at);
  return kNumParameters;
}

std::optional<DotFit> DotFitter::Conclude(const Parameters& at, const Normal& normal,
                                          int free) const {
  const int freedom = pixels_->count() - free;
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
