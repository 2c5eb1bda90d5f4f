// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "fitting/fit.h"

namespace articap {

// A marker that sits elsewhere than the binding has it, throughout a take: it was glued anew, or is
// another one's name.
struct DisplacedMarker {
  std::string name;
  double distance_mm = 0;  // mm of the rig
};

// Markers whose residual is large in comparison with the other markers', and points in one
// direction frame after frame, seen from the rig. The sum of distances leaves such a marker where
// it is rather than bend the face towards it, so that its residual shows the displacement.
std::vector<DisplacedMarker> FindDisplacedMarkers(const ShapeFit& fit);

}  // namespace articap
