// SPDX-License-Identifier: MIT
#pragma once

#include "calib/calibration.h"
#include "calib/mirror_calibration.h"
#include "calib/network.h"
#include "core/result.h"

namespace articap {

// Where the mirrors and the board are, roughly, the lens being known: planes that reflect the board
// from where pictures show it directly to where they show it mirrored, each tried on all pictures,
// the one that explains most taken first. Sightings that none explains are added to `set_aside`.
// Refused: pictures that show fewer mirrors than there should be.
Result<Network> StartMirrorNetwork(const BoardSpec& board, const CameraSightings& input,
                                   const Camera& camera, const MirrorOptions& options,
                                   LeftOutSightings& set_aside);

}  // namespace articap
