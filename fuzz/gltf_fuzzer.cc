// SPDX-License-Identifier: MIT
#include <optional>

#include "fuzz/fuzz_input.h"
#include "rig/io/gltf_import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = articap::ParseGltf(articap::TextOf(data, size), "fuzz", std::nullopt);
  if (!model) {
    articap::Require(!model.error().message.empty());
    return 0;
  }
  const articap::MorphSource source = articap::MorphSourceOf(*model, "fuzz");
  for (const Eigen::Vector3i& triangle : source.triangles)
    articap::Require(triangle.minCoeff() >= 0 &&
                     triangle.maxCoeff() < static_cast<int>(source.vertices.size()));
  for (const auto& target : source.targets)
    for (const int vertex : target.field.vertices)
      articap::Require(vertex >= 0 && vertex < static_cast<int>(source.vertices.size()));
  return 0;
}
