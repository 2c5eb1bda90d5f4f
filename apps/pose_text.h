// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// "jaw_rotation=10deg,lip_rounding=3mm" -> a value for every parameter of the rig (rad, mm, 1),
// zero where none is given. Rotations need deg or rad; millimetres and weights may leave the unit
// out. Unknown names, wrong units and values out of range are refused.
Result<Eigen::VectorXd> ParsePose(const std::string& text, const FaceRig& rig);

// "face_width=0.5,nose=-1" -> a value for every identity slider.
Result<Eigen::VectorXd> ParseIdentity(const std::string& text, const FaceRig& rig);

// What people read of a parameter's value: degrees for rotations.
const char* DisplayUnitOf(ParameterUnit unit);  // "deg", "mm", ""
double DisplayValueOf(double value, ParameterUnit unit);

}  // namespace articap
