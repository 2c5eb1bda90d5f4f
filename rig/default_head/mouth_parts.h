// SPDX-License-Identifier: MIT
#pragma once

#include "rig/default_head/half_mesh.h"

namespace articap {

// Vertices at the middle of the incisal edges, on the labial side: landmarks.
struct Incisors {
  int upper = 0;
  int lower = 0;
};

// Both rows of teeth on their dental arches, in their gums.
Incisors AddTeeth(HalfMesh& half);

void AddTongue(HalfMesh& half);

}  // namespace articap
