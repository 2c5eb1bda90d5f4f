// SPDX-License-Identifier: MIT
#include "rig/io/gltf_import.h"
namespace articap {
Result<MorphSource> ReadGltfTargets(const std::filesystem::path& path) {
  return Fail("not yet " + path.string());
}
}  // namespace articap
