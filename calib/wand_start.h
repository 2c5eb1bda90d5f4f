// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "calib/wand_calibration.h"
#include "calib/wand_network.h"
#include "core/result.h"

namespace articap {

// Where the cameras and the wand are, roughly: relative poses of pairs of cameras from the pictures
// in which the wand moves least, scaled by its length; a tree over the best pairs; the wand's ends
// triangulated, and followed so that the same one comes first all the time. Time offsets are taken
// for 0. Refused: cameras that nothing links with the first.
Result<WandNetwork> StartWandNetwork(const std::vector<WandVideo>& videos, double length_mm);

// Leaves out what only one camera sees.
void KeepSharedInstants(WandNetwork& network);

}  // namespace articap
