// SPDX-License-Identifier: MIT
#include "calib/wand_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/calib/network_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

constexpr double kRate_hz = 60;
constexpr double kLength_mm = 120;

// A wand that is waved through the volume for a while: at most 0.9 m/s.
std::array<Eigen::Vector3d, 2> WandAt(double time_s) {
  const auto wave = [&](double hz, double phase) {
    return std::sin(2 * std::numbers::pi * hz * time_s + phase);
  };
  const Eigen::Vector3d middle{110 * wave(0.53, 0.2), 90 * wave(0.41, 1.1),
                               800 + 110 * wave(0.67, 2.0)};
  const Eigen::Vector3d along =
      Eigen::Vector3d{wave(0.31, 0), 0.7 * wave(0.43, 1.3), 0.8 * wave(0.37, 2.6)}.normalized();
  return {middle + kLength_mm / 2 * along, middle - kLength_mm / 2 * along};
}

struct WandScene {
  CameraArray array;
  std::vector<WandVideo> videos;
};

WandScene WaveWand(int num_cameras, int num_frames, double noise_px, unsigned seed) {
  WandScene scene;
  scene.array = RigScene(seed, num_cameras, 1).array;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  std::uniform_real_distribution<double> offset(-0.5 / kRate_hz, 0.5 / kRate_hz);
  for (std::size_t i = 0; i < scene.array.cameras.size(); ++i) {
    Camera& camera = scene.array.cameras[i];
    if (i > 0) camera.time_offset_s = offset(random);
    WandVideo video{camera.name, camera.width, camera.height, camera.lens, {}};
    for (int frame = 0; frame < num_frames; ++frame) {
      WandPicture picture;
      picture.time = TimeOfFrame(frame, kRate_hz);
      const double true_s = SecondsOf(picture.time) + camera.time_offset_s;
      for (const Eigen::Vector3d& end : WandAt(true_s))
        if (const auto point = Project(camera.lens, camera.cam_from_stage * end))
          picture.points_px.push_back(*point + Eigen::Vector2d{noise(random), noise(random)});
      // Nobody says which end is which.
      if (random() % 2 == 0) std::reverse(picture.points_px.begin(), picture.points_px.end());
      video.pictures.push_back(picture);
    }
    scene.videos.push_back(video);
  }
  return scene;
}

TEST(WandCalibrationTest, OffsetsAndScaleComeOut) {
  WandOptions options;
  options.length_mm = kLength_mm;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const WandScene scene = WaveWand(4, 400, 0.1, seed);
    const auto wand = CalibrateWand(scene.videos, options);
    ASSERT_TRUE(wand) << wand.error().message;
    EXPECT_TRUE(wand->report.IsUsable()) << wand->report.BriefReport();
    double largest_offset_frames = 0, largest_scale = 0;
    for (int i = 1; i < 4; ++i) {
      const Camera& found = wand->output.array.cameras[i];
      const Camera& truth = scene.array.cameras[i];
      largest_offset_frames = std::max(
          largest_offset_frames, std::abs(found.time_offset_s - truth.time_offset_s) * kRate_hz);
      const double baseline_mm = truth.cam_from_stage.translation_mm.norm();
      largest_scale = std::max(
          largest_scale, std::abs(found.cam_from_stage.translation_mm.norm() / baseline_mm - 1));
      EXPECT_LT(found.cam_from_stage.rotation.angularDistance(truth.cam_from_stage.rotation), 1e-3);
    }
    std::printf(
        "seed %u: offsets to %.4f frames, baselines to %.4f %%, wand score %.3f, mean "
        "length %.4f of %.0f mm, %.3f px RMS\n",
        seed, largest_offset_frames, 100 * largest_scale, wand->output.wand_score,
        wand->output.mean_length_mm, kLength_mm, wand->output.rms_px);
    EXPECT_LT(largest_offset_frames, 0.05);
    EXPECT_LT(largest_scale, 5e-4);
    EXPECT_NEAR(wand->output.mean_length_mm, kLength_mm, 5e-4 * kLength_mm);
  }
}

TEST(WandCalibrationTest, WithoutOffsetsTheWandSeemsToStretch) {
  const WandScene scene = WaveWand(4, 300, 0.1, 4);
  WandOptions options;
  options.length_mm = kLength_mm;
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
  options.length_mm = kLength_mm;
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
  options.length_mm = kLength_mm;
  const auto wand = CalibrateWand(scene.videos, options);
  ASSERT_FALSE(wand);
  EXPECT_THAT(wand.error().message, HasSubstr("cam1: 0 of 100 pictures show two markers"));
}

}  // namespace
}  // namespace articap
