// SPDX-License-Identifier: MIT
#include "synthetic/noise.h"

#include <gmock/gmock.h>

#include <cmath>

namespace articap {
namespace {

constexpr int kFrames = 4000;
constexpr int kMarkers = 10;
constexpr int kSamples = kFrames * kMarkers;

MarkerRecording StillMarkers() {
  std::vector<std::string> names;
  for (int marker = 0; marker < kMarkers; ++marker) names.push_back("m" + std::to_string(marker));
  MarkerRecording recording;
  recording.tracks = StageTracks(names, kFrames, 100);
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker)
      recording.tracks.Set(frame, marker, Eigen::Vector3d(20.0 * marker, 5, 1000));
  return recording;
}

Eigen::Vector3d Displacement(const DisturbedRecording& disturbed, int frame, int marker) {
  return disturbed.markers.tracks.position_mm(frame, marker) -
         Eigen::Vector3d(20.0 * marker, 5, 1000);
}

// Four standard deviations of a binomial count: fails once in 16,000 seeds, and seeds are fixed.
void ExpectBinomial(int count, int trials, double probability) {
  const double sd = std::sqrt(trials * probability * (1 - probability));
  EXPECT_NEAR(count, trials * probability, 4 * sd);
}

TEST(AddNoiseTest, NothingAskedNothingChanged) {
  const DisturbedRecording disturbed = AddNoise(StillMarkers(), {}, 1);
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker)
      ASSERT_EQ(Displacement(disturbed, frame, marker).norm(), 0);
  EXPECT_EQ(disturbed.Count(SampleFault::kNone), kSamples);
}

TEST(AddNoiseTest, NoiseHasTheStandardDeviationAsked) {
  SyntheticNoiseOptions options;
  options.noise_mm = 0.2;
  const DisturbedRecording disturbed = AddNoise(StillMarkers(), options, 1);
  Eigen::Vector3d sums = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker) {
      const Eigen::Vector3d noise = Displacement(disturbed, frame, marker) / options.noise_mm;
      sums += noise;
      squares += noise.cwiseAbs2();
    }
  // Chi-square with n degrees of freedom: mean n, SD sqrt(2 n).
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(squares[axis], kSamples, 4 * std::sqrt(2.0 * kSamples)) << "axis " << axis;
    EXPECT_NEAR(sums[axis], 0, 4 * std::sqrt(1.0 * kSamples)) << "axis " << axis;
  }
}

TEST(AddNoiseTest, DropoutsComeAsOftenAsAskedAndAreMissing) {
  SyntheticNoiseOptions options;
  options.dropout = 0.2;
  const DisturbedRecording disturbed = AddNoise(StillMarkers(), options, 2);
  ExpectBinomial(disturbed.Count(SampleFault::kDropout), kSamples, 0.2);
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker)
      ASSERT_EQ(disturbed.markers.tracks.is_missing(frame, marker),
                disturbed.fault(frame, marker) == SampleFault::kDropout);
}

TEST(AddNoiseTest, GapsCoverTheFractionAskedInBursts) {
  SyntheticNoiseOptions options;
  options.gap = 0.1;
  options.gap_length_s = 0.2;  // 20 frames
  const DisturbedRecording disturbed = AddNoise(StillMarkers(), options, 3);
  int bursts = 0;
  for (int marker = 0; marker < kMarkers; ++marker)
    for (int frame = 0; frame < kFrames; ++frame)
      bursts += disturbed.fault(frame, marker) == SampleFault::kGap &&
                (frame == 0 || disturbed.fault(frame - 1, marker) == SampleFault::kNone);
  const int missing = disturbed.Count(SampleFault::kGap);
  const double expected_bursts = 0.1 * kSamples / 20;
  EXPECT_NEAR(bursts, expected_bursts, 4 * std::sqrt(expected_bursts));
  // Geometric lengths have an SD of about their mean.
  EXPECT_NEAR(1.0 * missing / bursts, 20, 4 * 20 / std::sqrt(expected_bursts));
}

TEST(AddNoiseTest, OutliersAreAsFarOffAndAsFrequentAsAsked) {
  SyntheticNoiseOptions options;
  options.dropout = 0.2;
  options.outliers = 0.02;
  options.outlier_mm = 10;
  const DisturbedRecording disturbed = AddNoise(StillMarkers(), options, 4);
  const int seen = kSamples - disturbed.Count(SampleFault::kDropout);
  ExpectBinomial(disturbed.Count(SampleFault::kOutlier), seen, 0.02);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker) {
      if (disturbed.markers.tracks.is_missing(frame, marker)) continue;
      const Eigen::Vector3d offset = Displacement(disturbed, frame, marker);
      const bool outlier = disturbed.fault(frame, marker) == SampleFault::kOutlier;
      ASSERT_NEAR(offset.norm(), outlier ? 10 : 0, 1e-9);
      sum += offset;
    }
  // Each axis of a random direction has the variance 1/3.
  const double sd = 10 * std::sqrt(disturbed.Count(SampleFault::kOutlier) / 3.0);
  EXPECT_LT(sum.cwiseAbs().maxCoeff(), 4 * sd);
}

TEST(AddNoiseTest, OutliersLeaveTheNoiseAsItWas) {
  SyntheticNoiseOptions options;
  options.noise_mm = 0.2;
  const DisturbedRecording without = AddNoise(StillMarkers(), options, 5);
  options.outliers = 0.02;
  const DisturbedRecording with = AddNoise(StillMarkers(), options, 5);
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker)
      if (with.fault(frame, marker) == SampleFault::kNone) {
        ASSERT_EQ(with.markers.tracks.position_mm(frame, marker),
                  without.markers.tracks.position_mm(frame, marker));
      }
}

TEST(AddNoiseTest, SwapsExchangeNeighbours) {
  SyntheticNoiseOptions options;
  options.swaps_hz = 1;
  options.swap_length_s = 0.1;
  const DisturbedRecording disturbed = AddNoise(StillMarkers(), options, 6);
  EXPECT_GT(disturbed.Count(SampleFault::kSwap), 0);
  for (int frame = 0; frame < kFrames; ++frame)
    for (int marker = 0; marker < kMarkers; ++marker) {
      const bool swapped = disturbed.fault(frame, marker) == SampleFault::kSwap;
      ASSERT_NEAR(Displacement(disturbed, frame, marker).norm(), swapped ? 20 : 0, 1e-9);
    }
}

TEST(AddNoiseTest, OptionsThatMakeNoSenseAreNamed) {
  SyntheticNoiseOptions options;
  EXPECT_TRUE(CheckOptions(options));
  options.dropout = 2;
  ASSERT_FALSE(CheckOptions(options));
  EXPECT_THAT(CheckOptions(options).error().message, testing::HasSubstr("dropout is 2"));
  options.dropout = 0;
  options.noise_mm = -0.1;
  EXPECT_FALSE(CheckOptions(options));
}

}  // namespace
}  // namespace articap
