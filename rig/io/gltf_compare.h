// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "rig/face_rig.h"
#include "rig/io/gltf_export.h"
#include "rig/io/gltf_model.h"
#include "rig/io/gltf_plan.h"

namespace articap {

// Evaluates an exported file as another program would, float32, and measures how far its vertices
// are from the rig's: in the neutral pose, at both ends of every parameter, in random poses, and in
// some 50 key frames of its animation.
ExportReport CompareWithRig(const FaceRig& rig, const TargetPlan& plan, GltfModel model,
                            const std::optional<RigAnimation>& animation);

}  // namespace articap
