// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// Parameters as people type them, "jaw_rotation=10deg", "lip_rounding=3mm", "jaw_shift=2": without
// a unit the value is in the rig's own (rad for rotations). Those not named are 0. Unknown names
// and values that are no numbers or outside the range fail, and the message lists what there is.
Result<Eigen::VectorXd> ParsePose(const FaceRig& rig, const std::vector<std::string>& assignments);

// Identity sliders, "face_width=0.08"; nothing for those not named.
Result<std::vector<std::optional<double>>> ParseIdentity(
    const FaceRig& rig, const std::vector<std::string>& assignments);

}  // namespace articap
