// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/marker_set.h"
#include "core/result.h"
#include "core/virtual_marker.h"
#include "rig/face_rig.h"
#include "synthetic/random.h"

namespace articap {

// Glues every marker of the set to the skin (or the spectacles) at its landmark, with its height
// above the surface: up to `misplacement_mm` beside it, as hands place markers. It stays in the
// region that the set asks for, or else in its landmark's.
Result<std::vector<VirtualMarker>> AttachMarkers(const FaceRig& rig, const MarkerSet& set,
                                                 double misplacement_mm, RandomGenerator& random);

}  // namespace articap
