// SPDX-License-Identifier: MIT
#include "synthetic/smooth_steps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace articap {
namespace {

TEST(TriweightStepTest, IsTheIntegralOfTheTriweightKernel) {
  EXPECT_EQ(TriweightStep(-1), 0);
  EXPECT_EQ(TriweightStep(1), 1);
  EXPECT_EQ(TriweightStep(0), 0.5);
  const double h = 1e-4;
  for (double x = -0.99; x < 1; x += 0.01) {
    const double slope = (TriweightStep(x + h) - TriweightStep(x - h)) / (2 * h);
    EXPECT_NEAR(slope, 35.0 / 32 * std::pow(1 - x * x, 3), 1e-7);
  }
}

SmoothSteps Example() {
  SmoothSteps steps(0.1);
  steps.Add(0.5, 0);
  steps.Add(0.8, 3, 2);
  steps.Add(0.86, -1, 0.5);
  steps.Add(1.2, 1);
  return steps;
}

TEST(SmoothStepsTest, HoldsItsTargetsInsideOfSegments) {
  const SmoothSteps steps = Example();
  EXPECT_EQ(steps.At(-5), 0);
  EXPECT_EQ(steps.At(0.39), 0);
  EXPECT_DOUBLE_EQ(steps.At(0.65), 3);
  EXPECT_DOUBLE_EQ(steps.At(1.0), 1);
  EXPECT_DOUBLE_EQ(steps.At(99), 1);
}

TEST(SmoothStepsTest, StaysWithinItsTargets) {
  const SmoothSteps steps = Example();
  for (double t = 0; t < 1.5; t += 0.001) {
    EXPECT_GE(steps.At(t), -1);
    EXPECT_LE(steps.At(t), 3);
  }
}

TEST(SmoothStepsTest, HeavyNeighboursPullLightShortTargets) {
  EXPECT_GT(Example().At(0.83), 0) << "the target there is -1, its heavy neighbour's 3";
}

TEST(SmoothStepsTest, AStepAcceleratesAsItsKernelHasIt) {
  // A lone step of equal weights is the step times TriweightStep: its acceleration peaks at
  // 1.878 step / half_width^2.
  SmoothSteps steps(0.1);
  steps.Add(0, 0);
  steps.Add(1, 2);
  const double h = 1e-4;
  double peak = 0;
  for (double t = -0.12; t < 0.12; t += h) {
    const double acceleration = (steps.At(t + h) - 2 * steps.At(t) + steps.At(t - h)) / (h * h);
    peak = std::max(peak, std::abs(acceleration));
  }
  EXPECT_NEAR(peak, 1.878 * 2 / 0.01, 2);
}

}  // namespace
}  // namespace articap
