// SPDX-License-Identifier: MIT
#pragma once

#include "rig/default_head/half_mesh.h"

namespace articap {

// The auricle: 64 mm high, 35 mm broad, standing off the head by some 22 degrees.
void AddEar(HalfMesh& half);

}  // namespace articap
