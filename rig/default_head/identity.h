// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "rig/default_head/face_shape.h"
#include "rig/default_head/half_mesh.h"
#include "rig/default_head/skin.h"
#include "rig/default_head/weights.h"

namespace articap {

// What the fields of the identity sliders are made from.
struct IdentityInputs {
  const HalfMesh& half;
  const Skin& skin;
  const FaceShape& shape;
  const LipDistances& lip_distances;
  const std::vector<double>& jaw_weights;
  Eigen::Vector3d jaw_pivot;
};

// Displacement of every vertex of the half mesh per unit of a slider, by the slider's name.
Result<std::vector<Eigen::Vector3d>> IdentityField(const std::string& name,
                                                   const IdentityInputs& inputs);

}  // namespace articap
