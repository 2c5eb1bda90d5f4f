// SPDX-License-Identifier: MIT
#include "core/marker_set.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  articap::RequireRoundTrip(
      articap::TextOf(data, size),
      [](const std::string& text) { return articap::ParseMarkerSet(text, "fuzz"); },
      articap::WriteMarkerSet);
  return 0;
}
