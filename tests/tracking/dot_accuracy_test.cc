// SPDX-License-Identifier: MIT
// Dots whose light is sampled, not modelled, through photons, reading out and rounding, against the
// Cramer-Rao bound of each.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/tracking/dot_trial.h"

namespace articap {
namespace {

constexpr double kLargestBias_px = 0.003;
constexpr double kLargestRatio = 1.2;

void Print(const std::string& what, const DotTrialResult& result, double bound_px) {
  std::printf(
      "%-24s RMSE %.5f px, %.3f of the bound; bias by phase up to %.5f px; diameter %.3f px; "
      "%.2f sigma; misfit %.2f\n",
      what.c_str(), result.rmse_px(), result.rmse_px() / bound_px, result.largest_phase_bias_px(),
      result.mean_diameter_px(), result.rms_over_sigma(), result.mean_misfit());
}

// All are found, and nothing else.
void ExpectFound(const DotTrial& trial, const DotTrialResult& result) {
  EXPECT_EQ(result.missed, 0);
  EXPECT_EQ(result.extra, 0);
  ASSERT_GE(static_cast<int>(result.samples.size()), trial.count);
}

class DotSizeTest : public testing::TestWithParam<double> {};

// 20,000 dots in all: a tenth of a pixel has five hundred, whose mean is good to 0.0004 px.
TEST_P(DotSizeTest, IsAsAccurateAsNoiseAllowsAtEveryPhase) {
  DotTrial trial;
  trial.dot = PaintedDot::Disc({0, 0}, GetParam());
  trial.count = 5000;
  const DotTrialResult result = RunTrial(trial, 1);
  ExpectFound(trial, result);
  const double bound_px = BoundOf(trial);
  Print(std::to_string(static_cast<int>(GetParam())) + " px", result, bound_px);
  EXPECT_LE(result.rmse_px(), kLargestRatio * bound_px);
  EXPECT_LE(result.largest_phase_bias_px(), kLargestBias_px);
  EXPECT_NEAR(result.mean_diameter_px(), GetParam(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Sizes, DotSizeTest, testing::Values(6, 10, 16, 30));

struct Condition {
  const char* name;
  void (*set)(DotTrial& trial);
  // Mean square of the errors over the stated covariances.
  double least_sigma = 0.8, most_sigma = 1.15;
};

void PrintTo(const Condition& condition, std::ostream* stream) { *stream << condition.name; }

const Condition kConditions[] = {
    {"16 bit", [](DotTrial& trial) { trial.sensor.format = PixelFormat::kGray16; }},
    {"sharp", [](DotTrial& trial) { trial.dot.blur_px = 0.5; }},
    {"soft", [](DotTrial& trial) { trial.dot.blur_px = 1.2; }},
    {"faint", [](DotTrial& trial) { trial.dot.contrast = 0.15; }},
    {"small well",
     [](DotTrial& trial) {
       trial.sensor.full_well_e = 2000;
       trial.sensor.read_noise_e = 10;
     }},
    {"large well",
     [](DotTrial& trial) {
       trial.sensor.full_well_e = 100000;
       trial.sensor.format = PixelFormat::kGray16;
     }},
    {"roundness 0.7",
     [](DotTrial& trial) {
       trial.dot.semi_axes_px =
           trial.dot.semi_axes_px.cwiseProduct(Eigen::Vector2d(1 / std::sqrt(0.7), std::sqrt(0.7)));
       trial.turns = true;
     }},
    {"roundness 0.5",
     [](DotTrial& trial) {
       trial.dot.semi_axes_px =
           trial.dot.semi_axes_px.cwiseProduct(Eigen::Vector2d(1 / std::sqrt(0.5), std::sqrt(0.5)));
       trial.turns = true;
     }},
    {"bright on dark",
     [](DotTrial& trial) {
       trial.background = 0.03;
       trial.dot.contrast = 0.82;
     }},
    {"slope of light",
     [](DotTrial& trial) {
       trial.slope_per_px = {0.003, -0.002};
     }},
    {"dark",
     [](DotTrial& trial) {
       trial.background = 0.8;
       trial.dot.contrast = -0.5;
       trial.options.polarity = DotPolarity::kDark;
     }},
};

class DotConditionTest : public testing::TestWithParam<std::tuple<Condition, double>> {};

TEST_P(DotConditionTest, IsAsAccurateAsNoiseAllows) {
  const auto& [condition, diameter_px] = GetParam();
  DotTrial trial;
  trial.dot = PaintedDot::Disc({0, 0}, diameter_px);
  trial.count = 500;
  condition.set(trial);
  const DotTrialResult result = RunTrial(trial, 2);
  // Where slopes meet there are ridges of light, which may look like dots.
  EXPECT_EQ(result.missed, 0);
  if (trial.slope_per_px.isZero()) {
    EXPECT_EQ(result.extra, 0);
  }
  const double bound_px = BoundOf(trial);
  Print(std::string(condition.name) + ", " + std::to_string(static_cast<int>(diameter_px)) + " px",
        result, bound_px);
  // A thousand errors have a root mean square that is good to 2.2 %.
  EXPECT_LE(result.rmse_px(), kLargestRatio * bound_px);
  EXPECT_GE(result.rms_over_sigma(), condition.least_sigma);
  EXPECT_LE(result.rms_over_sigma(), condition.most_sigma);
  // Fifty dots a tenth of a pixel, twenty means of which the largest is taken.
  EXPECT_LE(result.largest_phase_bias_px(),
            kLargestBias_px + 3.5 * result.rmse_px() / std::sqrt(50.0));
}

INSTANTIATE_TEST_SUITE_P(Conditions, DotConditionTest,
                         testing::Combine(testing::ValuesIn(kConditions),
                                          testing::Values(6.0, 16.0)));

TEST(DotAccuracyTest, EdgesTellWhereSaturatedDotsAre) {
  for (const double diameter_px : {6.0, 10.0, 16.0}) {
    DotTrial trial;
    trial.dot = PaintedDot::Disc({0, 0}, diameter_px);
    trial.dot.contrast = 1.2;
    trial.count = 500;
    const DotTrialResult result = RunTrial(trial, 3);
    ExpectFound(trial, result);
    const double bound_px = BoundOf(trial);
    Print("saturated, " + std::to_string(static_cast<int>(diameter_px)) + " px", result, bound_px);
    EXPECT_LE(result.rmse_px(), kLargestRatio * bound_px);
    for (const auto& sample : result.samples) EXPECT_TRUE(sample.found.saturated);
  }
}

// 29 % of the dot's area are behind an edge as dark as what surrounds the dot.
TEST(DotAccuracyTest, WhatIsHiddenIsFlaggedAndHardlyMovesTheRest) {
  RandomGenerator random(4, 1);
  DotDetector detector({});
  double sum2 = 0, largest = 0;
  constexpr int kCount = 100;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector2d center{32 + random.Uniform(), 32 + random.Uniform()};
    LightPicture light(64, 64, 0.2);
    light.Add(PaintedDot::Disc(center, 16));
    light.Cover(center.x() + 8 / 3.0, 0.2, 0.7);
    const auto dots = detector.Detect(TakePicture(light, {}, random).view(), {});
    ASSERT_EQ(dots.size(), 1u);
    EXPECT_TRUE(dots[0].occluded);
    const double error_px = (dots[0].center_px - center).norm();
    sum2 += error_px * error_px;
    largest = std::max(largest, error_px);
  }
  std::printf("a third hidden: RMS error %.3f px, at most %.3f px\n", std::sqrt(sum2 / kCount),
              largest);
  // The middle of what is to be seen lies 2.2 px beside.
  EXPECT_LE(std::sqrt(sum2 / kCount), 0.5);
}

// A retro-reflective ball behind a bar as dark as the rest: neither an ellipse with another middle
// nor a shade may stand for the edge.
TEST(DotAccuracyTest, SmallDotsCutOffAreTakenForWhatTheyAre) {
  RandomGenerator random(6, 1);
  DotDetector detector({});
  double sum2 = 0;
  int flagged = 0;
  constexpr int kCount = 200;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector2d center{32 + random.Uniform(), 32 + random.Uniform()};
    LightPicture light(64, 64, 0.03);
    PaintedDot dot = PaintedDot::Disc(center, 6.6);
    dot.contrast = 0.82;
    light.Add(dot);
    // A quarter of its area.
    light.Cover(center.x() + 0.4 * 3.3, 0.02, 0.7);
    const auto dots = detector.Detect(TakePicture(light, {}, random).view(), {});
    ASSERT_EQ(dots.size(), 1u);
    flagged += dots[0].occluded ? 1 : 0;
    sum2 += (dots[0].center_px - center).squaredNorm();
  }
  std::printf("a quarter of a small dot hidden: RMS error %.3f px, %d of %d flagged\n",
              std::sqrt(sum2 / kCount), flagged, kCount);
  EXPECT_GE(flagged, 0.9 * kCount);
  // The middle of what is to be seen lies 0.8 px beside.
  EXPECT_LE(std::sqrt(sum2 / kCount), 0.3);
}

struct MeanOfDots {
  double error_x_px = 0;
  double diameter_px = 0;
};

MeanOfDots MeanOf(const DotTrialResult& result) {
  MeanOfDots mean;
  const auto count = static_cast<double>(result.samples.size());
  for (const auto& sample : result.samples) {
    mean.error_x_px += sample.error_px.x() / count;
    mean.diameter_px += sample.found.diameter_px() / count;
  }
  return mean;
}

// A camcorder's tone bends the edge's profile: on even ground alike on all sides, on a slope not.
TEST(DotAccuracyTest, ToneMovesDotsOnSlopesUnlessItIsUndone) {
  DotTrial trial;
  trial.dot = PaintedDot::Disc({0, 0}, 10);
  trial.slope_per_px = {0.005, 0};
  trial.background = 0.25;
  trial.dot.contrast = 0.5;
  trial.sensor.srgb_tone = true;
  trial.count = 1000;
  const MeanOfDots left = MeanOf(RunTrial(trial, 5));
  trial.options.tone = DotTone::kSrgb;
  const MeanOfDots undone = MeanOf(RunTrial(trial, 5));
  std::printf(
      "sRGB tone, slope of 1 %% of the contrast a pixel: %.4f px beside, %.3f px wide; "
      "undone: %.4f px beside, %.3f px wide\n",
      left.error_x_px, left.diameter_px, undone.error_x_px, undone.diameter_px);
  // The mean of a thousand is good to 0.0003 px.
  EXPECT_LE(std::abs(undone.error_x_px), 0.0015);
  EXPECT_GT(std::abs(left.error_x_px), 2 * std::abs(undone.error_x_px));
  EXPECT_NEAR(undone.diameter_px, 10, 0.02);
}

}  // namespace
}  // namespace articap
