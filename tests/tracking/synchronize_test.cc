// SPDX-License-Identifier: MIT
#include "tracking/synchronize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace articap {
namespace {

constexpr double kRate_hz = 60;

CameraArray TwoCameras(double offset_of_second_s) {
  CameraArray array;
  array.cameras.resize(2);
  for (Camera& camera : array.cameras) {
    camera.width = 640;
    camera.height = 480;
  }
  array.cameras[1].time_offset_s = offset_of_second_s;
  return array;
}

// A marker that swings at 3 Hz over 40 px, as lips do.
Eigen::Vector2d SwingingAt(double time_s) {
  const double phase = 2 * std::numbers::pi * 3 * time_s;
  return {300 + 20 * std::sin(phase), 400 + 5 * std::cos(phase)};
}

Dot DotAt(const Eigen::Vector2d& center_px) {
  Dot dot;
  dot.center_px = center_px;
  dot.covariance_px2 = 0.0004 * Eigen::Matrix2d::Identity();
  return dot;
}

// `delay_s`: by which every frame is taken after the first camera's; `ahead_s`: of its clock.
DotVideo VideoOf(double delay_s, double ahead_s, double row_time_s) {
  DotVideo video;
  video.width = 640;
  video.height = 480;
  video.rate_hz = kRate_hz;
  for (int frame = 0; frame < 60; ++frame) {
    const double time_s = frame / kRate_hz + delay_s;
    DotPicture picture;
    picture.index = frame;
    picture.time = SessionTimeFromSeconds(time_s + ahead_s);
    // The row that it is seen in says when; it moves little meanwhile.
    const double rows = SwingingAt(time_s).y() - 239.5;
    picture.dots = {DotAt(SwingingAt(time_s + row_time_s * rows)), DotAt({100, 239.5})};
    video.pictures.push_back(picture);
  }
  return video;
}

double LargestError_px(const SynchronizedDots& result, int camera) {
  double largest = 0;
  for (int frame = 2; frame < 58; ++frame) {
    const Dot& dot = result.instants[frame][camera][0];
    largest = std::max(largest, (dot.center_px - SwingingAt(frame / kRate_hz)).norm());
  }
  return largest;
}

TEST(SynchronizeTest, SynchronousVideosStayAsTheyAre) {
  const auto result = Synchronize(TwoCameras(0), {VideoOf(0, 0, 0), VideoOf(0, 0, 0)}, {});
  ASSERT_EQ(result.instants.size(), 60U);
  EXPECT_EQ(result.largest_shift_s, 0);
  EXPECT_LT(LargestError_px(result, 1), 1e-6);
}

TEST(SynchronizeTest, AnotherClockAndAnotherPhase) {
  // The second camera films 6 ms later, and its clock is 0.1 s ahead.
  const auto result = Synchronize(TwoCameras(-0.1), {VideoOf(0, 0, 0), VideoOf(0.006, 0.1, 0)}, {});
  EXPECT_NEAR(result.largest_shift_s, 0.006, 1e-6);
  // Left as it is, it would be off by 20 px 2 pi 3 Hz 6 ms = 2.3 px. What a cubic leaves is the
  // fourth derivative times (t - t1) (t - t2) (t - t3) (t - t4) / 24: 0.039 px with frames of 16.7
  // ms.
  EXPECT_LT(LargestError_px(result, 1), 0.045);
  EXPECT_LT(LargestError_px(result, 0), 1e-6);
}

TEST(SynchronizeTest, RollingShutter) {
  SynchronizeOptions options;
  options.row_time_us = 25;  // 160 rows below the middle: 4 ms late
  const auto result =
      Synchronize(TwoCameras(0), {VideoOf(0, 0, 25e-6), VideoOf(0, 0, 25e-6)}, options);
  EXPECT_GT(result.largest_shift_s, 0.003);
  EXPECT_LT(LargestError_px(result, 0), 0.08);
}

TEST(SynchronizeTest, WhatCannotBeFollowedGetsUncertain) {
  DotVideo second = VideoOf(0.006, 0, 0);
  second.pictures[30].dots.push_back(DotAt({500, 100}));
  const auto result = Synchronize(TwoCameras(0), {VideoOf(0, 0, 0), second}, {});
  const std::vector<Dot>& dots = result.instants[30][1];
  ASSERT_EQ(dots.size(), 3U);
  EXPECT_EQ(dots[2].center_px, Eigen::Vector2d(500, 100));
  EXPECT_GT(dots[2].covariance_px2(0, 0), 0.0004);
}

TEST(SynchronizeTest, WhatWasNotFilmedIsNotSeen) {
  DotVideo second = VideoOf(0, 0, 0);
  second.pictures.erase(second.pictures.begin(), second.pictures.begin() + 20);
  const auto result = Synchronize(TwoCameras(0), {VideoOf(0, 0, 0), second}, {});
  EXPECT_TRUE(result.instants[5][1].empty());
  EXPECT_EQ(result.instants[30][1].size(), 2U);
}

TEST(SynchronizeTest, AVariableRateBecomesEven) {
  DotVideo video = VideoOf(0, 0, 0);
  video.constant_rate = false;
  for (std::size_t i = 0; i < video.pictures.size(); i += 2) {
    const double time_s = static_cast<double>(i) / kRate_hz + 0.004;
    video.pictures[i].time = SessionTimeFromSeconds(time_s);
    video.pictures[i].dots[0] = DotAt(SwingingAt(time_s));
  }
  const auto result = Synchronize(TwoCameras(0), {video, VideoOf(0, 0, 0)}, {});
  ASSERT_GE(result.instants.size(), 58U);
  for (int frame = 3; frame < 56; ++frame) {
    const double time_s = SecondsOf(result.start) + frame / kRate_hz;
    EXPECT_LT((result.instants[frame][0][0].center_px - SwingingAt(time_s)).norm(), 0.15);
  }
}

}  // namespace
}  // namespace articap
