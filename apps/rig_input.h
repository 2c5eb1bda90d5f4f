// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// The rig of a folder, or the built-in default head where the folder is empty.
Result<FaceRig> ChooseRig(const std::string& folder);

// The rig with identity sliders as people type them, "face_width=0.08"; others stay.
Result<FaceRig> WithIdentityText(const FaceRig& rig, const std::vector<std::string>& assignments);

}  // namespace articap
