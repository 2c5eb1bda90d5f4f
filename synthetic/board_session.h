// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/board.h"
#include "synthetic/board_scene.h"

namespace articap {

// Which board somebody calibrates with, and the ways in which it is held: picture i is held by way
// i modulo their number.
struct BoardSession {
  BoardSpec board;
  std::vector<BoardPoseOptions> ways;
};

// Of a ring: so that two cameras see the board. Of mirrors: two pictures of three halfway between
// the camera and a mirror, so that both see the front, the mirrors in turn; one of three towards
// the camera, all over its picture, for the lens.
BoardSession BoardSessionFor(const SyntheticCameras& cameras);

Result<std::vector<Rigid3d>> BoardPosesOf(const Studio& studio, const BoardSession& session,
                                          int num_pictures, std::uint64_t seed);

// A machine-vision camera: a little blur and vignetting, noise of photons and of reading out.
SensorOptions MachineVision();

// For Expose(): every picture of a take or session has noise of its own.
std::uint64_t PictureSeed(std::uint64_t seed, int camera, int picture);

}  // namespace articap
