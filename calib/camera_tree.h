// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/camera.h"

namespace articap {

// How two cameras stand to one another, from what both see.
struct CameraPair {
  int first = 0;
  int second = 0;
  Rigid3d second_from_first;
};

// Places cameras by a spanning tree over pairs, the best pair first: it grows from the first
// camera, whose frame the stage's becomes, each time by the best pair that leads out of it. Which
// cameras it reaches; the others stay where they were.
std::vector<bool> PlaceByPairs(const std::vector<CameraPair>& pairs, std::vector<Camera>& cameras);

}  // namespace articap
