// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "calib/calibration.h"
#include "calib/instants.h"
#include "calib/network.h"
#include "core/result.h"

namespace articap {

// A sighting of a camera with its lens known: which instant it shows, and where the board may be.
struct PlacedSighting {
  SightingKey key;
  Instant instant;
  std::vector<Rigid3d> cam_from_board;  // one or two candidates
  const BoardSighting* sighting = nullptr;
};

// Where cameras stand to one another, from boards that two or more see at the same instant: of each
// pair the relative pose that explains most of their shared views, both planar poses of each being
// tried; then a spanning tree over the pairs that share the most. The stage frame is the first
// camera's. Refused, by name: cameras that no chain of shared views links with the first, and
// pairs whose views contradict one another.
Result<Network> LinkCameras(const BoardSpec& board, const std::vector<Camera>& cameras,
                            const std::vector<PlacedSighting>& sightings);

}  // namespace articap
