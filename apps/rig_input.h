// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// The rig of a folder, or the built-in default head where the folder is empty.
Result<FaceRig> ChooseRig(const std::string& folder);

}  // namespace articap
