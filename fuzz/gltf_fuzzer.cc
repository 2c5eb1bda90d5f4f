// SPDX-License-Identifier: MIT
#include "rig/io/gltf_import.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* ending : {".glb", ".gltf"}) {
    const articap::TemporaryFile file(data, size, ending);
    const auto source = articap::ReadGltfTargets(file.path());
    articap::Require(source.has_value() || !source.error().message.empty());
  }
  return 0;
}
