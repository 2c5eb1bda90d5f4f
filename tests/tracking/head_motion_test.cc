// SPDX-License-Identifier: MIT
#include "tracking/head_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "synthetic/random.h"

namespace articap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kFrame_s = 0.04;
const Eigen::Vector3d kCenter_mm(5, -60, 90);

// What a frame makes of the prediction when it measures the pose itself.
PoseEstimate Combine(const PoseEstimate& prior, const Rigid3d& measured, const Matrix6d& noise) {
  const Matrix6d gain = (prior.covariance + noise).llt().solve(prior.covariance).transpose();
  const PoseChange apart = ChangeBetween(prior.template_from_stage, measured, prior.center_mm);
  return {Changed(prior.template_from_stage, prior.center_mm, gain * apart), prior.center_mm,
          prior.covariance - gain * prior.covariance};
}

Matrix6d Noise(double rotation_sigma_rad, double translation_sigma_mm) {
  return PoseEstimate::Isotropic({}, kCenter_mm, rotation_sigma_rad, translation_sigma_mm)
      .covariance;
}

PoseChange Draw(const Matrix6d& covariance, RandomGenerator& random) {
  PoseChange normal;
  normal << random.NormalVector(), random.NormalVector();
  return covariance.llt().matrixL() * normal;
}

Rigid3d Nodding(double time_s) {
  const double phase = 2 * std::numbers::pi * time_s;
  return Changed({}, kCenter_mm,
                 (PoseChange() << 0.2 * std::sin(phase), 0.4 * std::sin(0.4 * phase), 0,
                  20 * std::sin(0.3 * phase), 5 * std::cos(0.7 * phase), 0)
                     .finished());
}

TEST(HeadMotionTest, WhatGoesOnIsPredicted) {
  HeadMotion motion(kCenter_mm, {});
  motion.Start(Nodding(0));
  const Matrix6d noise = Noise(0.0005, 0.05);
  RandomGenerator random(1, 1);
  double squares_mm2 = 0, standing_mm2 = 0;
  int counted = 0;
  for (int frame = 1; frame < 250; ++frame) {
    const Rigid3d truth = Nodding(frame * kFrame_s);
    const PoseEstimate predicted = motion.Predict(kFrame_s);
    const Eigen::Vector3d chin = truth.Inverse() * Eigen::Vector3d(0, -90, 80);
    const auto error_mm = [&](const Rigid3d& pose) {
      return (pose * chin - truth * chin).squaredNorm();
    };
    if (frame > 5) {
      squares_mm2 += error_mm(predicted.template_from_stage);
      standing_mm2 += error_mm(Nodding((frame - 1) * kFrame_s));
      ++counted;
    }
    motion.Update(kFrame_s,
                  Combine(predicted, Changed(truth, kCenter_mm, Draw(noise, random)), noise));
  }
  EXPECT_LT(std::sqrt(squares_mm2 / counted), 0.5);
  EXPECT_LT(squares_mm2, 0.2 * standing_mm2) << "a head that is expected to stand still";
}

// Poses drawn from the process itself are as far from their predictions as these say.
TEST(HeadMotionTest, ThePredictionsCovarianceIsRight) {
  LabelOptions options;
  options.attitude_sigma_deg = 10;  // rotation vectors of larger turns do not add up
  HeadMotion drawn(kCenter_mm, options);
  HeadMotion motion(kCenter_mm, options);
  drawn.Start({});
  motion.Start({});
  const Matrix6d noise = Noise(0.02, 3), known = Noise(1e-6, 1e-6);
  RandomGenerator random(2, 1);
  double mahalanobis = 0;
  constexpr int kFrames = 2000;
  for (int frame = 0; frame < kFrames; ++frame) {
    const PoseEstimate next = drawn.Predict(kFrame_s);
    const Rigid3d truth =
        Changed(next.template_from_stage, kCenter_mm, Draw(next.covariance, random));
    drawn.Update(kFrame_s, {truth, kCenter_mm, known});
    const PoseEstimate predicted = motion.Predict(kFrame_s);
    const PoseChange error = ChangeBetween(predicted.template_from_stage, truth, kCenter_mm);
    mahalanobis += error.dot(predicted.covariance.llt().solve(error));
    motion.Update(kFrame_s,
                  Combine(predicted, Changed(truth, kCenter_mm, Draw(noise, random)), noise));
  }
  EXPECT_NEAR(mahalanobis / 6 / kFrames, 1, 0.1);
}

// A turn that nothing more is seen of comes to rest, and to where the head usually is.
TEST(HeadMotionTest, WhatIsNotSeenDoesNotRunAway) {
  HeadMotion motion(kCenter_mm, {});
  motion.Start({});
  const Matrix6d noise = Noise(0.001, 0.1);
  const auto turned = [](double angle_rad) {
    return Changed({}, kCenter_mm, (PoseChange() << 0, angle_rad, 0, 0, 0, 0).finished());
  };
  for (int frame = 1; frame <= 10; ++frame)
    motion.Update(kFrame_s,
                  Combine(motion.Predict(kFrame_s), turned(0.02 * frame), noise));  // 29 deg/s
  double largest_rad = 0;
  Rigid3d pose;
  for (int frame = 0; frame < 250; ++frame) {
    const PoseEstimate predicted = motion.Predict(kFrame_s);
    motion.Update(kFrame_s, predicted);
    pose = predicted.template_from_stage;
    largest_rad =
        std::max(largest_rad, pose.rotation.angularDistance(Eigen::Quaterniond::Identity()));
  }
  EXPECT_LT(largest_rad, 0.45);
  EXPECT_LT(pose.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.01);
}

}  // namespace
}  // namespace articap
