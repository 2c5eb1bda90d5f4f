// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "rig/io/gltf_model.h"
#include "rig/io/morph_source.h"

namespace articap {

// The meshes and morph targets of a glTF 2.0 file (.gltf or .glb) in its rest pose: metres, groups
// named after materials (meshes where there is none), vertices numbered through in the order of
// nodes and primitives. Targets of one name in several meshes are one target.
Result<MorphSource> ReadGltfTargets(const std::filesystem::path& path);
MorphSource MorphSourceOf(const GltfModel& model, const std::string& name);

}  // namespace articap
