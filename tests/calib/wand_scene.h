// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "calib/wand_calibration.h"
#include "core/camera.h"

namespace articap {

constexpr double kWandRate_hz = 60;
constexpr double kWandLength_mm = 120;

struct WandScene {
  CameraArray array;  // truth
  std::vector<WandVideo> videos;
};

// A wand waved through the volume of RigScene(), at most 0.9 m/s, as its cameras show it with
// Gaussian noise; none but the first keeps the clock of the array, unless they are `synchronous`.
WandScene WaveWand(int num_cameras, int num_frames, double noise_px, unsigned seed,
                   bool synchronous = false);

}  // namespace articap
