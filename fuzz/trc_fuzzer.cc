// SPDX-License-Identifier: MIT
#include "fuzz/marker_target.h"

// Reading TRC.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using articap::MarkerFormat;
  static constexpr MarkerFormat kFormats[] = {MarkerFormat::kTrc, MarkerFormat::kC3d};
  articap::CheckMarkerBytes(std::as_bytes(std::span(data, size)), "fuzz.trc", kFormats);
  return 0;
}
