// SPDX-License-Identifier: MIT
#include "core/parameter_track.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  articap::RequireRoundTrip(
      articap::TextOf(data, size),
      [](const std::string& text) { return articap::ParseParameterCsv(text, "fuzz"); },
      articap::WriteParameterCsv);
  return 0;
}
