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
  made.model = {{{0.3f, -0.2f}, 0.09f, 0.015f, 0.07f, 0.8f}, 0.5, 0.2, {0.002, -0.003}};
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
    default:
      moved.slope_per_px[parameter - 8] += step;
  }
  return moved;
}

// J^T W r is minus half the derivative of r^T W r.
TEST(DotEquationsTest, GradientIsThatOfTheSumOfSquares) {
  const Case made = MakeCase();
  DotEquations equations;
  const auto normal =
      equations.At(made.pixels, made.model, made.noise, DotEquations::Weights::kByModel);
  const double scales[] = {1, 1, 0.05, 0.05, 0.05, 1, 1, 1, 0.05, 0.05};
  for (int i = 0; i < DotEquations::kNumParameters; ++i) {
    const double step = 3e-3 * scales[i];
    const auto chi2 = [&](double by) {
      return equations.At(made.pixels, Moved(made.model, i, by), made.noise,
                          DotEquations::Weights::kKept)(10, 10);
    };
    const double slope = (chi2(step) - chi2(-step)) / (2 * step);
    // What the curvature's derivatives would add is left out; the sums are floats.
    EXPECT_NEAR(-2 * normal(i, 10), slope, 0.1 * std::abs(slope) + 2e-3 * normal(10, 10))
        << "parameter " << i;
  }
}

TEST(DotEquationsTest, EveryLevelOfInstructionsGivesTheSameBits) {
  const Case made = MakeCase();
  for (const auto weights : {DotEquations::Weights::kByModel, DotEquations::Weights::kByLoss}) {
    DotEquations plain(SimdLevel::kNone), best(BestSimdLevel());
    const auto first = plain.At(made.pixels, made.model, made.noise, weights, 0.1);
    const auto second = best.At(made.pixels, made.model, made.noise, weights, 0.1);
    EXPECT_TRUE(first == second);
    EXPECT_EQ(plain.disbelieved(), best.disbelieved());
  }
}

TEST(PixelNoiseTest, IsToldFromAPicture) {
  RandomGenerator random(2, 1);
  PaintSensor sensor;
  LightPicture light(640, 480);
  // Steps of brightness, with texture in a tenth of it.
  for (int y = 0; y < light.height; ++y)
    for (int x = 0; x < light.width; ++x)
      light.at(x, y) = 0.05 + 0.1 * (x / 64) * 0.9 + (y >= 432 ? 0.03 * ((x / 2 + y / 3) % 2) : 0);
  const Image image = TakePicture(light, sensor, random);
  PixelReader reader({});
  reader.Open(image.view());
  NoiseSamples samples;
  reader.SampleNoise(samples);
  const PixelNoise noise = samples.Estimate(reader.least_variance());
  // Some thousand samples; the texture that remains among the smallest 60 % makes it a little
  // large.
  for (const double value : {0.1, 0.4, 0.8})
    EXPECT_NEAR(noise.VarianceAt(value) / sensor.VarianceAt(value), 1, 0.2) << value;
}

}  // namespace
}  // namespace articap
