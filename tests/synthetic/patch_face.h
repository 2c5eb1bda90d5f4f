// SPDX-License-Identifier: MIT
#pragma once

#include "core/marker_set.h"
#include "rig/face_rig.h"

namespace articap {

// The least of a face that can speak: two curved sheets of skin that meet at the mouth, with all
// ten articulatory parameters, and spectacles above that nothing moves.
FaceRig MakePatchFace();

// Markers "s1" to "s3" on the spectacles, and nine on the face, 2 mm above the skin.
MarkerSet PatchFaceMarkers();

}  // namespace articap
