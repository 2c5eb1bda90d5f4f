// SPDX-License-Identifier: MIT
#include "tracking/dot_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace articap {
namespace {

// The first of each kind; slope, bend and shade are two, two and three.
enum Parameter {
  kX,
  kY,
  kXx,
  kXy,
  kYy,
  kBlur,
  kContrast,
  kBackground,
  kSlope,
  kBend = kSlope + 2,
  kShade = kBend + 2,
  kShadeOfHeight = kShade + 2
};

// A pixel's own square has an SD of 1/sqrt(12) px, which no lens undercuts.
constexpr double kLeastBlur_px = 0.289;
constexpr int kMostSteps = 8;
constexpr int kMostRobustSteps = 2;  // at each width of the loss
// The square of the last step, which is taken without another look at the pixels, in units of the
// standard deviations that the misfit makes likely; where the ground is looked at next, of a step
// that is made good there.
constexpr double kArrived2 = 0.5;
constexpr double kNear2 = 4;

constexpr int kNum = DotEquations::kNumParameters;
using Parameters = Eigen::Matrix<double, kNum, 1>;
using Normal = DotEquations::Normal;
// Of some of the parameters.
using SomeByAll = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kNum, kNum>;
using Some = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNum, 1>;

Parameters Pack(const DotModel& model) {
  const DotEllipse& dot = model.ellipse;
  Parameters at;
  at << dot.center_px.cast<double>(), dot.xx, dot.xy, dot.yy, dot.blur_px, model.contrast,
      model.background, model.slope_per_px, model.bend_per_px2, model.shade;
  return at;
}

DotModel Unpack(const Parameters& at) {
  const Eigen::Matrix<float, kNum, 1> values = at.cast<float>();
  return {{values.head<2>(), values[kXx], values[kXy], values[kYy], values[kBlur]},
          at[kContrast],
          at[kBackground],
          at.segment<2>(kSlope),
          at.segment<2>(kBend),
          at.segment<3>(kShade)};
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

// Of the first `kFree` parameters.
template <int kFree>
Some DampedStepOf(const Normal& normal, double damping) {
  Eigen::Matrix<double, kFree, kFree> damped = normal.topLeftCorner<kFree, kFree>();
  damped.diagonal() *= 1 + damping;
  damped.diagonal().array() += 1e-12 * damped.diagonal().maxCoeff();
  const Eigen::Matrix<double, kFree, 1> side = normal.col(kNum).head<kFree>();
  return damped.llt().solve(side);
}

Some DampedStep(const Normal& normal, int free, double damping) {
  switch (free) {
    case DotEquations::kNumEven:
      return DampedStepOf<DotEquations::kNumEven>(normal, damping);
    case kBend:
      return DampedStepOf<kBend>(normal, damping);
    case kShade:
      return DampedStepOf<kShade>(normal, damping);
    case kShadeOfHeight:
      return DampedStepOf<kShadeOfHeight>(normal, damping);
    default:
      return DampedStepOf<kNum>(normal, damping);
  }
}

// What chi^2 is by noise alone a pixel, as the variances have more in them.
double ExpectedOf(const DotEquations::Own& own, double model_variance) {
  return 1 - model_variance * own.weight / own.count;
}

// Root mean square of what the noise does not explain, over the contrast.
double LeftOf(const DotEquations::Own& own, double model_variance, double contrast) {
  const double expected = own.count * ExpectedOf(own, model_variance);
  return std::sqrt(std::max(0.0, own.chi2 - expected) / own.weight) / contrast;
}

}  // namespace

std::optional<DotFit> DotFitter::Fit(const DotPixels& pixels, const DotModel& start,
                                     const PixelNoise& noise, DotGround ground, double most_left) {
  State state;
  Start(pixels, start, noise, state);
  if (ground == DotGround::kUneven) state.free = kShade;
  Minimise(Weights::kByModel, ground == DotGround::kSupported ? kNear2 : kArrived2, kMostSteps,
           state);
  if (!(LeftOf(state.own, model_variance_, state.at[kContrast]) <= most_left)) return std::nullopt;
  Extend(kMostSteps, state);
  return Conclude(state);
}

std::optional<DotFit> DotFitter::FitShaded(const DotPixels& pixels, const DotModel& start,
                                           const PixelNoise& noise) {
  State state;
  Start(pixels, start, noise, state);
  state.free = kNum;
  Evaluate(Weights::kByModel, state);
  constexpr double kMostSaturated = 0.3;
  if (pixels.num_saturated() > kMostSaturated * state.own.count) return std::nullopt;
  // Of chi^2, by the first step: where it is less, the rest of the way has been in vain.
  constexpr double kLeastFall = 0.1;
  const Some step = DampedStep(state.normal, kNum, 0);
  if (!(step.dot(state.normal.col(kNum).head<kNum>()) > kLeastFall * state.normal(kNum, kNum)))
    return std::nullopt;
  const State even = state;
  Descend(true, kArrived2, kMostSteps, state);
  // Nothing is darker in its middle.
  if (state.at[kShadeOfHeight] < 0) {
    state = even;
    state.free = kShadeOfHeight;
    Descend(true, kArrived2, kMostSteps, state);
  }
  return Conclude(state);
}

std::optional<DotFit> DotFitter::FitRobustly(const DotPixels& pixels, const DotModel& start,
                                             const PixelNoise& noise, double scale,
                                             double widening) {
  State state;
  Start(pixels, start, noise, state);
  constexpr int kPasses = 5;
  for (int pass = 0; pass < kPasses; ++pass, widening = std::max(1.0, widening / 2)) {
    Evaluate(Weights::kByLoss, state, widening * scale * state.at[kContrast]);
    Descend(false, kArrived2, kMostRobustSteps, state);
    if (pass == kPasses - 1) Extend(kMostRobustSteps, state);
  }
  std::optional<DotFit> fit = Conclude(state);
  if (fit) fit->disbelieved = equations_.disbelieved();
  return fit;
}

void DotFitter::Start(const DotPixels& pixels, const DotModel& start, const PixelNoise& noise,
                      State& state) {
  pixels_ = &pixels;
  noise_ = noise;
  // What the profile itself may be off (dot_profile.h): where there is little noise, the foot of
  // the edge must not decide alone.
  constexpr double kProfileError = 0.004;
  model_variance_ = std::pow(kProfileError * start.contrast, 2);
  noise_.read_variance += model_variance_;
  largest_px_ = std::sqrt(pixels.count());
  steps_ = 0;
  state.at = Pack(start);
  state.free = !start.shade.isZero(0)          ? kNumParameters
               : !start.bend_per_px2.isZero(0) ? kShade
               : !start.slope_per_px.isZero(0) ? kBend
                                               : kEven;
}

void DotFitter::Evaluate(Weights weights, State& state, double scale) {
  const auto terms = state.free == kEven    ? DotEquations::Terms::kEven
                     : state.free <= kShade ? DotEquations::Terms::kGround
                                            : DotEquations::Terms::kAll;
  state.normal = equations_.At(*pixels_, Unpack(state.at), noise_, terms, weights, scale);
  state.own = equations_.own();
  // Where the range cuts the dot off, blur, contrast and size may replace one another: what is
  // usual decides.
  if (pixels_->num_saturated() == 0) return;
  constexpr double kUsualBlur_px = 0.75, kBlurSigma_px = 0.1;
  const double misfit = std::max(1.0, state.normal(kNum, kNum) / pixels_->count());
  const double information = misfit / (kBlurSigma_px * kBlurSigma_px);
  const double apart = kUsualBlur_px - state.at[kBlur];
  state.normal(kBlur, kBlur) += information;
  state.normal(kBlur, kNum) += information * apart;
  state.normal(kNum, kBlur) += information * apart;
  state.normal(kNum, kNum) += information * apart * apart;
}

void DotFitter::Minimise(Weights weights, double arrived2, int most_steps, State& state) {
  Evaluate(weights, state);
  Descend(weights == Weights::kByModel, arrived2, most_steps, state);
}

void DotFitter::Descend(bool weighs, double arrived2, int most_steps, State& state) {
  double damping = state.free > kShade ? 1e-2 : 1e-3;
  State other;
  State *now = &state, *next = &other;
  for (int tried = 0; tried < most_steps; ++tried, ++steps_) {
    const Some step = DampedStep(now->normal, now->free, damping);
    next->at = now->at;
    next->free = now->free;
    next->at.head(now->free) += step;
    KeepPossible(largest_px_, next->at);
    const double chi2 = now->normal(kNum, kNum);
    const double fall = step.dot(now->normal.col(kNum).head(now->free));
    const double moved2 =
        fall - damping * step.cwiseAbs2().dot(now->normal.diagonal().head(now->free));
    if (!(moved2 > arrived2 * std::max(1.0, chi2 / pixels_->count()))) {
      now->at = next->at;
      now->normal(kNum, kNum) -= fall;
      break;
    }
    Evaluate(weighs ? Weights::kByModel : Weights::kKept, *next);
    // Other weights change chi^2 a little.
    if (next->normal(kNum, kNum) <= (weighs ? 1.5 : 1.0) * chi2) {
      // What is far from the model by other things than noise is not worth small steps.
      constexpr double kWorthwhile = 0.01, kFar = 2;
      const bool is_worthwhile = weighs || next->normal(kNum, kNum) < (1 - kWorthwhile) * chi2 ||
                                 chi2 < kFar * pixels_->count();
      std::swap(now, next);
      if (!is_worthwhile) break;
      damping *= 0.1;
      weighs = false;
    } else {
      damping = std::max(10 * damping, 0.01);
    }
  }
  if (now != &state) state = *now;
}

void DotFitter::Extend(int most_steps, State& state) {
  if (state.free >= kShade) return;
  State more = state;
  more.free = kShade;
  Evaluate(Weights::kKept, more);
  more.free = SupportedBy(more, state.free);
  Descend(more.free != state.free, kArrived2, most_steps, more);
  state = more;
}

int DotFitter::SupportedBy(const State& all, int free) const {
  // What chi^2 falls by, in misfits.
  constexpr double kSlopeSupported = 12, kBendSupported = 16;
  const double misfit =
      std::max({1.0, all.normal(kNum, kNum) / pixels_->count(), all.own.chi2 / all.own.count});
  // With J^T W J = L L^T, each parameter that is freed after those before it lowers chi^2 by the
  // square of its component of L^-1 J^T W r.
  const Eigen::LLT<Eigen::Matrix<double, kShade, kShade>> triangle(
      all.normal.topLeftCorner<kShade, kShade>());
  if (triangle.info() != Eigen::Success) return free;
  const Eigen::Matrix<double, kShade, 1> falls =
      triangle.matrixL().solve(all.normal.col(kNum).head<kShade>());
  const auto gain = [&](int begin, int end) {
    begin = std::max(begin, free);
    return begin < end ? falls.segment(begin, end - begin).squaredNorm() / misfit : 0.0;
  };
  if (gain(kBend, kShade) > kBendSupported) return kShade;
  return gain(kSlope, kBend) > kSlopeSupported ? kBend : free;
}

std::optional<DotFit> DotFitter::Conclude(const State& state) const {
  const int freedom = pixels_->count() - state.free;
  const double contrast = state.at[kContrast];
  if (freedom < 1 || !state.at.allFinite() || contrast <= 0) return std::nullopt;
  DotFit fit;
  fit.model = Unpack(state.at);
  fit.steps = steps_;
  const double chi2 = state.normal(kNum, kNum);
  // Of all pixels, and of the dot's own, which tell where it is: where dots alone are bright, the
  // picture tells little of the noise that bright pixels have.
  const double count = pixels_->count(), per_freedom = count / freedom;
  const DotEquations::Own all = {count, state.normal(kBackground, kBackground), chi2 * per_freedom};
  fit.left = LeftOf(state.own, model_variance_, contrast);
  fit.left_of_all = LeftOf(all, model_variance_, contrast);
  fit.misfit = all.chi2 / count / ExpectedOf(all, model_variance_);
  const double scatter = std::max({ExpectedOf(state.own, model_variance_), all.chi2 / count,
                                   state.own.chi2 / state.own.count * per_freedom});
  const Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kNum, 2> covariance =
      SomeByAll(state.normal.topLeftCorner(state.free, state.free))
          .llt()
          .solve(SomeByAll(SomeByAll::Identity(state.free, 2)));
  fit.covariance_px2 = scatter * covariance.topRows<2>();
  if (!fit.covariance_px2.allFinite() || fit.covariance_px2.diagonal().minCoeff() <= 0)
    return std::nullopt;
  return fit;
}

}  // namespace articap
