// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.h"
#include "rig/io/morph_source.h"

namespace articap {

// The meshes and morph targets of a glTF 2.0 file (.gltf or .glb) in its rest pose, metres.
// Compressed and quantised files (Draco, meshopt, KHR_mesh_quantization) and sparse accessors are
// refused.
Result<MorphSource> ReadGltfTargets(const std::filesystem::path& path);

}  // namespace articap
