// SPDX-License-Identifier: MIT
#include "tracking/dot_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/tracking/dot_picture.h"
#include "tracking/pixel_reader.h"

namespace articap {
namespace {

// Pixels of values that a model does not fit, and a place where its derivatives are wanted.
struct Case {
  DotPixels pixels;
  DotModel model;
  PixelNoise noise{1e-4, 1e-4};
};

Case MakeCase() {
  Case made;
  made.model = {{{0.3f, -0.2f}, 0.09f, 0.015f, 0.07f, 0.8f},
                0.5,
                0.2,
                {0.002, -0.003},
                {0.0001, -0.0002},
                {0.1, -0.15, 0.2}};
  RandomGenerator random(1, 1);
  made.pixels.Start(1600);
  for (int y = -18; y <= 18; ++y)
    for (int x = -18; x <= 18; ++x)
      made.pixels.Add(static_cast<float>(x), static_cast<float>(y),
                      static_cast<float>(random.Uniform(0.1, 0.8)), (x + y) % 7 == 0);
  made.pixels.Finish();
  return made;
}

DotModel Moved(const DotModel& model, int parameter, double step) {
  DotModel moved = model;
  const auto add = [&](float& value) { value += static_cast<float>(step); };
  switch (parameter) {
    case 0:
    case 1:
      add(moved.ellipse.center_px[parameter]);
      break;
    case 2:
      add(moved.ellipse.xx);
      break;
    case 3:
      add(moved.ellipse.xy);
      break;
    case 4:
      add(moved.ellipse.yy);
      break;
    case 5:
      add(moved.ellipse.blur_px);
      break;
    case 6:
      moved.contrast += step;
      break;
    case 7:
      moved.background += step;
      break;
    case 8:
    case 9:
      moved.slope_per_px[parameter - 8] += step;
      break;
    case 10:
    case 11:
      moved.bend_per_px2[parameter - 10] += step;
      break;
    default:
      moved.shade[parameter - 12] += step;
  }
  return moved;
}

// An even dot.
Case MakeUnshadedCase() {
  Case made = MakeCase();
  made.model.shade.setZero();
  return made;
}

// On even ground.
Case MakeEvenCase() {
  Case made = MakeUnshadedCase();
  made.model.slope_per_px.setZero();
  made.model.bend_per_px2.setZero();
  return made;
}

// J^T W r is minus half the derivative of r^T W r.
void ExpectGradient(const Case& made, DotEquations::Terms terms, int num_parameters) {
  constexpr int kResidual = DotEquations::kNumParameters;
  DotEquations equations;
  const auto normal =
      equations.At(made.pixels, made.model, made.noise, terms, DotEquations::Weights::kByModel);
  const double scales[] = {1, 1, 0.05, 0.05, 0.05, 1, 1, 1, 0.05, 0.05, 0.005, 0.005, 1, 1, 1};
  for (int i = 0; i < num_parameters; ++i) {
    const double step = 3e-3 * scales[i];
    const auto chi2 = [&](double by) {
      return equations.At(made.pixels, Moved(made.model, i, by), made.noise, terms,
                          DotEquations::Weights::kKept)(kResidual, kResidual);
    };
    const double slope = (chi2(step) - chi2(-step)) / (2 * step);
    // What the curvature's derivatives would add is left out; the sums are floats.
    EXPECT_NEAR(-2 * normal(i, kResidual), slope,
                0.1 * std::abs(slope) + 2e-3 * normal(kResidual, kResidual))
        << "parameter " << i;
  }
}

TEST(DotEquationsTest, GradientIsThatOfTheSumOfSquares) {
  ExpectGradient(MakeCase(), DotEquations::Terms::kAll, DotEquations::kNumParameters);
  ExpectGradient(MakeUnshadedCase(), DotEquations::Terms::kGround, DotEquations::kNumGround);
  ExpectGradient(MakeEvenCase(), DotEquations::Terms::kEven, DotEquations::kNumEven);
}

void ExpectAllsCorner(const Case& made, DotEquations::Terms terms, int num_parameters) {
  DotEquations equations;
  const auto at = [&](DotEquations::Terms wanted) {
    return equations.At(made.pixels, made.model, made.noise, wanted,
                        DotEquations::Weights::kByModel);
  };
  const auto some = at(terms), all = at(DotEquations::Terms::kAll);
  const auto corner = [&](const DotEquations::Normal& normal) {
    return normal.topLeftCorner(num_parameters, num_parameters);
  };
  EXPECT_TRUE(corner(some).isApprox(corner(all), 1e-6));
  EXPECT_TRUE(some.rightCols<1>()
                  .head(num_parameters)
                  .isApprox(all.rightCols<1>().head(num_parameters), 1e-5));
}

TEST(DotEquationsTest, TermsThatAreZeroMayBeLeftOut) {
  ExpectAllsCorner(MakeEvenCase(), DotEquations::Terms::kEven, DotEquations::kNumEven);
  ExpectAllsCorner(MakeUnshadedCase(), DotEquations::Terms::kGround, DotEquations::kNumGround);
}

TEST(DotEquationsTest, EveryLevelOfInstructionsGivesTheSameBits) {
  const Case made = MakeCase();
  for (const auto weights : {DotEquations::Weights::kByModel, DotEquations::Weights::kByLoss}) {
    for (const auto terms :
         {DotEquations::Terms::kEven, DotEquations::Terms::kGround, DotEquations::Terms::kAll}) {
      DotEquations plain(SimdLevel::kNone), best(BestSimdLevel());
      const auto first = plain.At(made.pixels, made.model, made.noise, terms, weights, 0.1);
      const auto second = best.At(made.pixels, made.model, made.noise, terms, weights, 0.1);
      EXPECT_TRUE(first == second);
      EXPECT_EQ(plain.disbelieved(), best.disbelieved());
      EXPECT_EQ(plain.own().chi2, best.own().chi2);
    }
  }
}

TEST(PixelNoiseTest, IsToldFromAPicture) {
  RandomGenerator random(2, 1);
  PaintSensor sensor;
  LightPicture light(640, 480);
  // Steps of brightness, with texture in a third of it.
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x) {
      const int step = x / 64;
      light.at(x, y) = 0.05 + 0.09 * step + (y >= 320 ? 0.03 * ((x / 2 + y / 3) % 2) : 0);
    }
  const Image image = TakePicture(light, sensor, random);
  PixelReader reader({});
  reader.Open(image.view());
  NoiseSamples samples;
  reader.SampleNoise(samples);
  const PixelNoise noise = samples.Estimate(reader.least_variance());
  // Some thousand samples; the texture that remains among the smallest 60 % makes it a little
  // large.
  for (const double value : {0.1, 0.4, 0.8})
    EXPECT_NEAR(noise.VarianceAt(value) / sensor.VarianceAt(value), 1, 0.1) << value;
}

}  // namespace
}  // namespace articap
