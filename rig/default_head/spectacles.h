// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "rig/default_head/half_mesh.h"

namespace articap {

// A frame without lenses, with markers on it that tell the head's motion from the face's. Returns the
// vertices of the markers on bridge, upper outer corner of the left rim, and left temple.
std::array<int, 3> AddSpectacles(HalfMesh& half);

}  // namespace articap
