// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace articap {

// Lines of the left half of the face as a view from the front shows them: x, y in mm, rig frame.
// Along the lips the fraction runs from 0 at the midline to 1 at the corner, along the lids from 0
// at the inner to 1 at the outer corner.
enum class Lip { kUpper, kLower };
enum class Lid { kUpper, kLower };

Eigen::Vector2d VermilionBorder(Lip lip, double fraction);
Eigen::Vector2d LidMargin(Lid lid, double fraction);

// Where the closed lips meet, mm, rig frame.
Eigen::Vector3d LipSeam(double fraction);

}  // namespace articap
