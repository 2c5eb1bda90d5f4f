// SPDX-License-Identifier: MIT
#include "core/text_grid.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto grid = articap::ParseTextGrid(articap::TextOf(data, size), "fuzz");
  if (!grid) return 0;
  const articap::SessionTime times[] = {articap::SessionTimeFromSeconds(0),
                                        articap::SessionTimeFromSeconds(0.5)};
  for (const articap::TextGridTier& tier : grid->tiers)
    articap::Require(articap::LabelsOfFrames(tier, times).size() == 2);
  return 0;
}
