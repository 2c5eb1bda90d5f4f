// SPDX-License-Identifier: MIT
#include "calib/wand_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tests/calib/wand_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

TEST(WandCalibrationTest, OffsetsAndScaleComeOut) {
  WandOptions options;
  options.length_mm = kWandLength_mm;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const WandScene scene = WaveWand(4, 400, 0.1, seed);
    const auto wand = CalibrateWand(scene.videos, options);
    ASSERT_TRUE(wand) << wand.error().message;
    EXPECT_TRUE(wand->report.IsUsable()) << wand->report.BriefReport();
    double largest_offset_frames = 0, largest_scale = 0;
    for (int i = 1; i < 4; ++i) {
      const Camera& found = wand->output.array.cameras[i];
      const Camera& truth = scene.array.cameras[i];
      largest_offset_frames =
          std::max(largest_offset_frames,
                   std::abs(found.time_offset_s - truth.time_offset_s) * kWandRate_hz);
      const double baseline_mm = truth.cam_from_stage.translation_mm.norm();
      largest_scale = std::max(
          largest_scale, std::abs(found.cam_from_stage.translation_mm.norm() / baseline_mm - 1));
      EXPECT_LT(found.cam_from_stage.rotation.angularDistance(truth.cam_from_stage.rotation), 1e-3);
    }
    std::printf(
        "seed %u: offsets to %.4f frames, baselines to %.4f %%, wand score %.3f, mean "
        "length %.4f of %.0f mm, %.3f px RMS\n",
        seed, largest_offset_frames, 100 * largest_scale, wand->output.wand_score,
        wand->output.mean_length_mm, kWandLength_mm, wand->output.rms_px);
    EXPECT_LT(largest_offset_frames, 0.05);
    EXPECT_LT(largest_scale, 5e-4);
    EXPECT_NEAR(wand->output.mean_length_mm, kWandLength_mm, 5e-4 * kWandLength_mm);
  }
}

TEST(WandCalibrationTest, WithoutOffsetsTheWandSeemsToStretch) {
  const WandScene scene = WaveWand(4, 300, 0.1, 4);
  WandOptions options;
  options.length_mm = kWandLength_mm;
  const auto free = CalibrateWand(scene.videos, options);
  options.free_time_offsets = false;
  const auto held = CalibrateWand(scene.videos, options);
  ASSERT_TRUE(free && held);
  EXPECT_LT(free->output.rms_px, 0.2);
  EXPECT_GT(held->output.rms_px, 1);
  EXPECT_FALSE(held->report.IsUsable()) << "cameras that are not synchronous, taken for it";
}

TEST(WandCalibrationTest, FocalLengthsThatAreRoughlyKnownAreFound) {
  WandScene scene = WaveWand(4, 400, 0.1, 5);
  for (WandVideo& video : scene.videos) {
    video.lens.fx_px *= 1.04;
    video.lens.fy_px *= 1.04;
  }
  WandOptions options;
  options.length_mm = kWandLength_mm;
  options.adjust_focal = true;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_TRUE(wand) << wand.error().message;
  for (int i = 0; i < 4; ++i) {
    const Camera& found = wand->output.array.cameras[i];
    EXPECT_NEAR(found.lens.fx_px, scene.array.cameras[i].lens.fx_px,
                std::max(0.5, 4 * found.sigmas.fx_px));
  }
}

// The cameras of a scene of which everything else is as before are found within their sigmas.
void ExpectCamerasWithinSigmas(const WandScene& scene) {
  WandOptions options;
  options.length_mm = kWandLength_mm;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_TRUE(wand) << wand.error().message;
  EXPECT_TRUE(wand->report.IsUsable()) << wand->report.BriefReport();
  EXPECT_NEAR(wand->output.sigma_px, 0.1, 0.015);
  for (std::size_t i = 1; i < scene.array.cameras.size(); ++i) {
    const Camera& found = wand->output.array.cameras[i];
    const Camera& truth = scene.array.cameras[i];
    EXPECT_NEAR(found.time_offset_s, truth.time_offset_s, 5 * found.sigmas.time_offset_s) << i;
    EXPECT_LT((found.cam_from_stage.translation_mm - truth.cam_from_stage.translation_mm).norm(),
              4 * found.sigmas.translation_mm.norm())
        << i;
  }
}

TEST(WandCalibrationTest, ClocksMayBeOffByMoreThanHalfAFrame) {
  WandScene scene = WaveWand(3, 300, 0.1, 7);
  for (const auto& [camera, frames] : {std::pair{1, 0.9}, std::pair{2, -0.8}}) {
    double& offset_s = scene.array.cameras[camera].time_offset_s;
    for (WandPicture& picture : scene.videos[camera].pictures)
      picture.time =
          SessionTimeFromSeconds(SecondsOf(picture.time) + offset_s - frames / kWandRate_hz);
    offset_s = frames / kWandRate_hz;
  }
  ExpectCamerasWithinSigmas(scene);
}

TEST(WandCalibrationTest, CamerasMayLosePicturesOrTakeFewer) {
  WandScene scene = WaveWand(3, 500, 0.1, 8);
  std::mt19937 random(8);
  for (WandVideo& video : scene.videos)
    std::erase_if(video.pictures, [&](const WandPicture&) { return random() % 5 < 2; });
  ExpectCamerasWithinSigmas(scene);
  // The first camera takes half as many as the others.
  scene = WaveWand(3, 500, 0.1, 9);
  auto& slow = scene.videos[0].pictures;
  for (std::size_t i = 0; 2 * i < slow.size(); ++i) slow[i] = slow[2 * i];
  slow.resize(slow.size() / 2);
  ExpectCamerasWithinSigmas(scene);
}

// A wand that is longer than was said makes everything look smaller, and no residual shows it.
TEST(WandCalibrationTest, SigmasHoldTheErrorOfTheLength) {
  constexpr double kSigma_mm = 0.5;
  const WandScene scene = WaveWand(3, 300, 0.1, 10);
  WandOptions options;
  options.length_mm = kWandLength_mm - kSigma_mm;
  options.length_sigma_mm = kSigma_mm;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_TRUE(wand) << wand.error().message;
  for (int i : {1, 2}) {
    const Camera& found = wand->output.array.cameras[i];
    const double baseline_mm = scene.array.cameras[i].cam_from_stage.translation_mm.norm();
    const double error_mm = baseline_mm - found.cam_from_stage.translation_mm.norm();
    EXPECT_NEAR(error_mm, baseline_mm * kSigma_mm / kWandLength_mm, 0.3);
    EXPECT_NEAR(found.sigmas.translation_mm.norm(), error_mm, 0.3 * error_mm);
  }
}

TEST(WandCalibrationTest, MarkersThatAreNoWandAreRefused) {
  WandScene scene = WaveWand(4, 400, 0.1, 1);
  for (WandVideo& video : scene.videos)
    for (WandPicture& picture : video.pictures) picture.points_px[1] = picture.points_px[0];
  WandOptions options;
  options.length_mm = kWandLength_mm;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_FALSE(wand);
  EXPECT_THAT(wand.error().message,
              testing::AnyOf(HasSubstr("is the length right"), HasSubstr("cannot be linked")));
}

TEST(WandCalibrationTest, AShortRecordingOfAFastWandIsLinked) {
  WandOptions options;
  options.length_mm = kWandLength_mm;
  for (unsigned seed = 11; seed <= 14; ++seed) {
    WandScene scene = WaveWand(4, 240, 0.1, seed);
    // Every third picture: three times as fast.
    for (WandVideo& video : scene.videos) {
      std::vector<WandPicture> third;
      for (std::size_t i = 0; i < video.pictures.size(); i += 3) third.push_back(video.pictures[i]);
      video.pictures = std::move(third);
    }
    const auto wand = CalibrateWand(scene.videos, options);
    ASSERT_TRUE(wand) << wand.error().message;
    EXPECT_TRUE(wand->report.IsUsable()) << wand->report.BriefReport();
  }
}

TEST(WandCalibrationTest, SeparatePicturesGoByTheirNumbers) {
  WandScene scene = WaveWand(3, 100, 0.1, 7, /*synchronous=*/true);
  for (std::size_t camera = 0; camera < scene.videos.size(); ++camera) {
    WandVideo& video = scene.videos[camera];
    video.has_times = false;
    for (std::size_t i = 0; i < video.pictures.size(); ++i)
      video.pictures[i].time = SessionTime(std::chrono::seconds(i));
    // One camera lost its first pictures, another every second one.
    if (camera == 1) video.pictures.erase(video.pictures.begin(), video.pictures.begin() + 7);
    if (camera == 0)
      std::erase_if(video.pictures, [](const WandPicture& picture) {
        return std::llround(SecondsOf(picture.time)) % 2 == 1;
      });
  }
  WandOptions options;
  options.length_mm = kWandLength_mm;
  const auto clocks = CalibrateWand(scene.videos, options);
  ASSERT_FALSE(clocks);
  EXPECT_THAT(clocks.error().message, HasSubstr("cam0: separate pictures have no times"));
  options.free_time_offsets = false;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_TRUE(wand) << wand.error().message;
  // The noise of both coordinates, less what the instants' own six parameters take up.
  EXPECT_LT(wand->output.rms_px, 0.1 * std::sqrt(2.0) * 1.1) << wand->report.BriefReport();
  EXPECT_TRUE(wand->report.IsUsable());

  scene.videos[2].has_times = true;
  const auto mixed = CalibrateWand(scene.videos, options);
  ASSERT_FALSE(mixed);
  EXPECT_THAT(mixed.error().message, HasSubstr("cam2 is a video and cam0 separate pictures"));
}

TEST(WandCalibrationTest, ACameraThatSeesNoWandIsNamed) {
  WandScene scene = WaveWand(3, 100, 0.1, 6);
  for (WandPicture& picture : scene.videos[1].pictures) picture.points_px.resize(1);
  WandOptions options;
  options.length_mm = kWandLength_mm;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_FALSE(wand);
  EXPECT_THAT(wand.error().message, HasSubstr("cam1: 0 of 100 pictures show two markers"));
}

}  // namespace
}  // namespace articap
