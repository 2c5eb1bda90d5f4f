// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <vector>

#include "calib/calibration.h"
#include "core/camera.h"

namespace articap {

// Cameras around a board that is held up in many places: truth, and what the cameras see of it with
// Gaussian noise.
struct NetworkScene {
  CameraArray array;
  BoardSpec board;
  std::vector<Rigid3d> stage_from_board;
};

// One camera at the stage's origin and the board before it at arm's length, tilted up to 35
// degrees, reaching into all of the picture.
NetworkScene LensScene(unsigned seed, int num_views);

// Cameras on an arc of 120 degrees (2 cameras: 30 degrees) about the stage's volume, 800 mm from
// its middle, with slightly different lenses of 1280 x 720 pixels; the board in many places of the
// volume, turned to one camera or another. The stage frame is the first camera's.
NetworkScene RigScene(unsigned seed, int num_cameras, int num_placements);

// One camera of 1280 x 720 pixels and a mirror at 45 degrees beside the board, which shows both
// ways: the set-up of Rademan and Niesler. The stage frame is the camera's. A board of 12 mm
// squares.
NetworkScene MirrorScene(unsigned seed, int num_placements, double glass_mm = 0);

// What each camera sees of every placement; a board that is not wholly in the picture is not seen.
std::vector<CameraSightings> SeeBoards(const NetworkScene& scene, double noise_px, unsigned seed);

}  // namespace articap
