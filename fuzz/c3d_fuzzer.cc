// SPDX-License-Identifier: MIT
#include "fuzz/marker_target.h"

// Reading C3D.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using articap::MarkerFormat;
  static constexpr MarkerFormat kFormats[] = {MarkerFormat::kC3d, MarkerFormat::kTrc};
  articap::CheckMarkerBytes(std::as_bytes(std::span(data, size)), "fuzz.c3d", kFormats);
  return 0;
}
