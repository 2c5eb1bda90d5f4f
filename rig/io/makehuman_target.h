// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// A MakeHuman target: text lines "vertex dx dy dz", comments behind '#', or the same packed by
// gzip. The displacements are in the file's own unit, decimetres, unscaled.
Result<DisplacementField> ParseMakeHumanTarget(std::string_view bytes, int num_vertices,
                                               std::string_view source);

}  // namespace articap
