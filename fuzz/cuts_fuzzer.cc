// SPDX-License-Identifier: MIT
#include "capture/cuts.h"

#include "fuzz/fuzz_input.h"

// Lists of times by which takes are cut.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto cuts = articap::ParseCuts(articap::TextOf(data, size), "fuzz");
  if (!cuts) return 0;
  articap::Require(!cuts->empty());
  for (const articap::Cut& cut : *cuts) articap::Require(cut.end_s > cut.start_s);
  return 0;
}
