// SPDX-License-Identifier: MIT
#include "fuzz/marker_target.h"

// Reading CSV (Nexus, Motive, plain).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using articap::MarkerFormat;
  static constexpr MarkerFormat kFormats[] = {MarkerFormat::kPlainCsv, MarkerFormat::kNexusCsv,
                                              MarkerFormat::kMotiveCsv};
  articap::CheckMarkerBytes(std::as_bytes(std::span(data, size)), "fuzz.csv", kFormats);
  return 0;
}
