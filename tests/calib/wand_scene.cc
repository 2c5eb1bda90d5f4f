// SPDX-License-Identifier: MIT
#include "tests/calib/wand_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/calib/network_scene.h"

namespace articap {
namespace {

// The ends of the wand.
std::array<Eigen::Vector3d, 2> WandAt(double time_s) {
  const auto wave = [&](double hz, double phase) {
    return std::sin(2 * std::numbers::pi * hz * time_s + phase);
  };
  const Eigen::Vector3d middle{110 * wave(0.53, 0.2), 90 * wave(0.41, 1.1),
                               800 + 110 * wave(0.67, 2.0)};
  const Eigen::Vector3d along =
      Eigen::Vector3d{wave(0.31, 0), 0.7 * wave(0.43, 1.3), 0.8 * wave(0.37, 2.6)}.normalized();
  return {middle + kWandLength_mm / 2 * along, middle - kWandLength_mm / 2 * along};
}

}  // namespace

WandScene WaveWand(int num_cameras, int num_frames, double noise_px, unsigned seed,
                   bool synchronous) {
  WandScene scene;
  scene.array = RigScene(seed, num_cameras, 1).array;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  std::uniform_real_distribution<double> offset(-0.5 / kWandRate_hz, 0.5 / kWandRate_hz);
  for (std::size_t i = 0; i < scene.array.cameras.size(); ++i) {
    Camera& camera = scene.array.cameras[i];
    if (i > 0 && !synchronous) camera.time_offset_s = offset(random);
    WandVideo video{camera.name, camera.width, camera.height, camera.lens, {}};
    for (int frame = 0; frame < num_frames; ++frame) {
      WandPicture picture;
      picture.time = TimeOfFrame(frame, kWandRate_hz);
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

}  // namespace articap
