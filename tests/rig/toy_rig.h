// SPDX-License-Identifier: MIT
#pragma once

#include "rig/face_rig.h"

namespace articap {

// A curved patch of skin of 15 x 21 vertices with a mouth line, five parameters (jaw rotation,
// thrust and shift, a translation and a scaling of the lips) and one identity slider: enough of a
// rig for tests that need no face.
FaceRig MakeToyRig();

}  // namespace articap
