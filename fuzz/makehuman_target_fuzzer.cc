// SPDX-License-Identifier: MIT
#include "rig/io/makehuman_target.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kNumVertices = 100;
  const auto target =
      articap::ParseMakeHumanTarget(articap::TextOf(data, size), kNumVertices, "fuzz");
  if (!target) return 0;
  for (const int vertex : target->vertices) articap::Require(vertex >= 0 && vertex < kNumVertices);
  return 0;
}
