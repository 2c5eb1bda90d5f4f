// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// Heads outside this range are not heads, or their unit is wrong. Where the whole mesh was
// measured, it may have a neck.
constexpr double kMinHeadHeight_mm = 150;
constexpr double kMaxHeadHeight_mm = 300;
constexpr double kMaxHeadAndNeckHeight_mm = 400;

// How high the neutral head is, and between what that was measured: crown and menton where both are
// landmarks of the rig, else the whole mesh.
struct HeadSize {
  double height_mm = 0;
  std::string measured_between;
  double max_height_mm = kMaxHeadHeight_mm;
};
HeadSize MeasureHead(const FaceRig& rig);

// Refuses heads of an impossible size, and says which unit they look like.
Result<void> CheckHeadSize(const FaceRig& rig);

}  // namespace articap
