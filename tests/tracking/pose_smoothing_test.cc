// SPDX-License-Identifier: MIT
#include "tracking/pose_smoothing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/matchers.h"

namespace articap {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180;
constexpr double kRate_hz = 60;
const Eigen::Vector3d kPivot_mm(0, 5, -40);

// A head a metre from the stage's origin that nods by 5 degrees at `nod_hz` and sways by 20 mm.
Rigid3d TrueStageFromHead(int frame, double nod_hz) {
  const double time_s = frame / kRate_hz;
  const auto wave = [&](double hz) { return std::sin(2 * kPi * hz * time_s); };
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 2, -1).normalized()) *
      Eigen::AngleAxisd(5 * kDegree * wave(nod_hz), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d pivot_in_stage_mm(300 + 20 * wave(0.4), 900, 100 * wave(0.1));
  return {rotation, pivot_in_stage_mm - rotation * kPivot_mm};
}

struct Noise {
  double position_mm = 0.1;
  double rotation_rad = 0.15 * kDegree;
};

HeadPoseTrack MakeTrack(int num_frames, double nod_hz, const Noise& noise, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto deviates = [&] {
    return Eigen::Vector3d{normal(random), normal(random), normal(random)};
  };
  HeadPoseTrack track{StabilizationMode::kRigid, kRate_hz, 1, {}, {}};
  for (int frame = 0; frame < num_frames; ++frame) {
    const Rigid3d truth = TrueStageFromHead(frame, nod_hz);
    const Eigen::Vector3d turn = noise.rotation_rad * deviates();
    const Eigen::Quaterniond rotation =
        truth.rotation *
        Eigen::AngleAxisd(turn.norm(), turn.norm() > 0 ? turn.normalized() : turn.UnitX());
    const Eigen::Vector3d pivot_mm = truth * kPivot_mm + noise.position_mm * deviates();
    const Rigid3d stage_from_head{rotation, pivot_mm - rotation * kPivot_mm};
    track.poses.push_back({stage_from_head.Inverse(), 0.1, HeadPoseStatus::kOk});
  }
  return track;
}

// RMS over the known poses: of the pivot's coordinates, and of the angles.
struct Errors {
  double position_mm = 0;
  double rotation_rad = 0;
};

Errors ErrorsOf(const HeadPoseTrack& track, double nod_hz) {
  Errors errors;
  int count = 0;
  for (std::size_t frame = 0; frame < track.poses.size(); ++frame) {
    if (!track.poses[frame].is_known()) continue;
    const Rigid3d error =
        track.poses[frame].head_from_stage * TrueStageFromHead(static_cast<int>(frame), nod_hz);
    errors.position_mm += (error * kPivot_mm - kPivot_mm).squaredNorm() / 3;
    errors.rotation_rad += std::pow(2 * error.rotation.vec().norm(), 2) / 3;
    ++count;
  }
  return {std::sqrt(errors.position_mm / count), std::sqrt(errors.rotation_rad / count)};
}

TEST(PoseSmoothingTest, NoiseGoesAndNodsStay) {
  const Noise noise;
  HeadPoseTrack track = MakeTrack(3000, 3, noise);
  const std::vector<double> weights(3000, 7.0);
  const PoseSmoothing smoothing = SmoothPoses(weights, kPivot_mm, 0, &track);
  const Errors errors = ErrorsOf(track, 3);
  // A nod of 3 Hz leaves a tenth to a quarter of the band to be kept, and the root of that of the
  // noise; the sway is slower.
  EXPECT_LT(errors.rotation_rad, 0.55 * noise.rotation_rad);
  EXPECT_LT(errors.position_mm, 0.35 * noise.position_mm);
  // 9000 numbers know a sigma to 1/sqrt(18000) = 0.7 %.
  EXPECT_NEAR(smoothing.position_noise_mm, noise.position_mm, 0.04 * noise.position_mm);
  EXPECT_NEAR(smoothing.rotation_noise_deg * kDegree, noise.rotation_rad,
              0.04 * noise.rotation_rad);
  EXPECT_GT(smoothing.rotation_cutoff_hz.value(), 3);
  EXPECT_LT(smoothing.position_cutoff_hz.value(), 5);
}

TEST(PoseSmoothingTest, WithoutNoiseThereIsNothingToGain) {
  HeadPoseTrack track = MakeTrack(600, 9, {0, 0});
  const HeadPoseTrack before = track;
  const PoseSmoothing smoothing = SmoothPoses(std::vector<double>(600, 1.0), kPivot_mm, 0, &track);
  EXPECT_FALSE(smoothing.rotation_cutoff_hz.has_value());
  EXPECT_FALSE(smoothing.position_cutoff_hz.has_value());
  for (int frame = 0; frame < 600; ++frame)
    EXPECT_THAT(track.poses[frame].head_from_stage,
                Rigid3dNear(before.poses[frame].head_from_stage, 1e-12, 1e-9));
}

TEST(PoseSmoothingTest, UnknownPosesStayUnknownAndCountForNothing) {
  HeadPoseTrack track = MakeTrack(2000, 1, {});
  std::vector<double> weights(2000, 1.0);
  const auto hide = [&](int frame) {
    track.poses[frame] = {
        {}, std::numeric_limits<double>::quiet_NaN(), HeadPoseStatus::kTooFewReferences};
    weights[frame] = 0;
  };
  for (int frame = 500; frame < 900; ++frame) hide(frame);
  for (int frame = 1000; frame < 1900; frame += 5) hide(frame);
  SmoothPoses(weights, kPivot_mm, 0, &track);
  EXPECT_EQ(track.poses[700].status, HeadPoseStatus::kTooFewReferences);
  EXPECT_THAT(track.poses[700].head_from_stage, Rigid3dNear(Rigid3d{}, 0, 0));
  const Errors errors = ErrorsOf(track, 1);
  EXPECT_LT(errors.rotation_rad, 0.45 * Noise().rotation_rad);
  EXPECT_LT(errors.position_mm, 0.4 * Noise().position_mm);
}

TEST(PoseSmoothingTest, ImprecisePosesFollowTheirNeighbours) {
  HeadPoseTrack track = MakeTrack(1000, 1, {});
  std::vector<double> weights(1000, 1.0);
  for (int frame = 50; frame < 1000; frame += 50) {
    track.poses[frame].head_from_stage.translation_mm += Eigen::Vector3d(0, 5, 0);
    weights[frame] = 1e-4;
  }
  SmoothPoses(weights, kPivot_mm, 0, &track);
  EXPECT_LT(ErrorsOf(track, 1).position_mm, 0.5 * Noise().position_mm);
}

TEST(PoseSmoothingTest, AGivenCutoffLeavesHalfTheAmplitude) {
  HeadPoseTrack track = MakeTrack(1200, 5, {0, 0});
  SmoothPoses(std::vector<double>(1200, 1.0), kPivot_mm, 5, &track);
  double largest_rad = 0;
  for (int frame = 300; frame < 900; ++frame) {
    const Rigid3d still = TrueStageFromHead(0, 5);
    const Rigid3d turn = track.poses[frame].head_from_stage * still;
    largest_rad = std::max(largest_rad, 2 * turn.rotation.vec().norm());
  }
  EXPECT_NEAR(largest_rad, 2.5 * kDegree, 0.02 * kDegree);
}

TEST(PoseSmoothingTest, AHandfulOfPosesIsLeftAlone) {
  HeadPoseTrack track = MakeTrack(29, 1, {});
  const HeadPoseTrack before = track;
  SmoothPoses(std::vector<double>(29, 1.0), kPivot_mm, 0, &track);
  EXPECT_THAT(track.poses[10].head_from_stage, Rigid3dNear(before.poses[10].head_from_stage, 0, 0));
}

}  // namespace
}  // namespace articap
