// SPDX-License-Identifier: MIT
#pragma once

#include "rig/default_head/face_shape.h"
#include "rig/default_head/half_mesh.h"

namespace articap {

// The eyeball with sclera, iris and pupil, looking ahead. Returns the vertex at its centre, a pivot.
int AddEyeball(HalfMesh& half);

// The brow: a tapering cushion of hair on the skin.
void AddBrow(const FaceShape& shape, HalfMesh& half);

}  // namespace articap
