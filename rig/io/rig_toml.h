// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// What rig.toml holds: all of a rig but the tables with a line for each vertex.
struct RigToml {
  RigDefinition definition;  // weight maps have names alone; morphs and sliders have empty fields
  Eigen::VectorXd identity;  // value of every identity slider
};

Result<RigToml> ParseRigToml(std::string_view text, const std::string& source);
std::string RigTomlText(const RigDefinition& definition, const Eigen::VectorXd& identity);

// The names of units in files: "rad", "mm", "weight".
std::string_view UnitName(ParameterUnit unit);
std::optional<ParameterUnit> FindUnit(std::string_view name);

}  // namespace articap
