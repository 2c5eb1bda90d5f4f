// SPDX-License-Identifier: MIT
#include "fuzz/marker_target.h"

// Reading Qualisys TSV.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using articap::MarkerFormat;
  static constexpr MarkerFormat kFormats[] = {MarkerFormat::kQualisysTsv, MarkerFormat::kPlainCsv};
  articap::CheckMarkerBytes(std::as_bytes(std::span(data, size)), "fuzz.tsv", kFormats);
  return 0;
}
