// SPDX-License-Identifier: MIT
#include "calib/wand_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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
