// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/result.h"

namespace articap {

// The part of a picture that a view fills, "front/left=640x720+640+0" each, in place of what the
// array says of that view. Refused: views that do not exist, and what CheckRegions() refuses.
Result<void> SetViewRegions(const std::vector<std::string>& texts, CameraArray& array);

// Refused, naming the view: a region that does not lie within its picture.
Result<void> CheckRegions(const CameraArray& array);

}  // namespace articap
