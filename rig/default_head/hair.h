// SPDX-License-Identifier: MIT
#pragma once

#include "rig/default_head/face_shape.h"
#include "rig/default_head/half_mesh.h"

namespace articap {

// A cap of short hair over the cranium, down to the hairline.
void AddHair(const FaceShape& shape, HalfMesh& half);

}  // namespace articap
