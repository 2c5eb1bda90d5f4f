// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// What rig.toml says, names not yet looked up.
struct LipWeightSpec {
  std::string name;
  std::string mirror;  // name of the mirror image; empty: the map covers both halves
  bool on_upper = false;
  bool on_lower = false;
  std::vector<Eigen::Vector2d> along;  // value over the fraction from midline to corner
  double reach_mm = 0;
};

struct TransformSpec {
  std::string parameter;
  std::string weight;
  WeightedTransform::Kind kind = WeightedTransform::Kind::kTranslate;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  std::string about;  // landmark, of a scale
};

struct JawSpec {
  std::string pivot;
  Eigen::Vector3d axis, thrust_direction, shift_direction;
  std::string rotation, thrust, shift;
};

struct RigFile {
  std::string name;
  std::vector<RigParameter> parameters;
  std::vector<LipWeightSpec> lip_weights;
  std::vector<TransformSpec> transforms;
  JawSpec jaw;
  std::vector<IdentitySlider> identity;  // without their fields
};

// Reads the text of a rig.toml; `source_name` is for messages.
Result<RigFile> ParseRigFile(std::string_view text, std::string_view source_name);

// The one that is built in.
std::string_view DefaultRigToml();

}  // namespace articap
