// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/report.h"
#include "core/result.h"
#include "rig/face_rig.h"
#include "rig/io/import_recipe.h"
#include "rig/io/morph_source.h"

namespace articap {

// The articulatory parameters of Beskow's head, which importers look for.
constexpr std::array<std::string_view, 10> kArticulatoryParameters = {"jaw_rotation",
                                                                      "lip_rounding",
                                                                      "upper_lip_retraction",
                                                                      "upper_lip_raise",
                                                                      "lower_lip_retraction",
                                                                      "lower_lip_depression",
                                                                      "left_mouth_corner_stretch",
                                                                      "right_mouth_corner_stretch",
                                                                      "jaw_thrust",
                                                                      "jaw_shift"};

struct ImportOptions {
  std::string unit;           // mm, cm, dm, m, in; "": as the recipe or the format says, else mm
  bool use_jaw_joint = true;  // false: linear morphs alone, even where the recipe defines a joint
};

// Makes a rig of linear morphs, with a jaw joint where the recipe has one. The report lists the
// articulatory parameters that the rig lacks, targets without use, and the size of the head.
Result<StageResult<FaceRig>> BuildMorphRig(const MorphSource& source, const ImportRecipe& recipe,
                                           const ImportOptions& options);

}  // namespace articap
