// SPDX-License-Identifier: MIT
#pragma once

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// The talking head of this project: skin, eyes, teeth, tongue and spectacles made from measurements
// (docs/default-head.md), with the ten articulatory parameters of rig/default_head/rig.toml and six
// identity sliders. The same bytes at every call; mirror symmetric to the bit.
Result<FaceRig> MakeDefaultHead();

}  // namespace articap
