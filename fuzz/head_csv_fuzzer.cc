// SPDX-License-Identifier: MIT
#include "core/head_pose.h"
#include "core/head_shape.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = articap::TextOf(data, size);
  articap::RequireRoundTrip(
      text, [](const std::string& csv) { return articap::ParseHeadPoseCsv(csv, "fuzz"); },
      articap::WriteHeadPoseCsv);
  articap::RequireRoundTrip(
      text, [](const std::string& csv) { return articap::ParseHeadShapeCsv(csv, "fuzz"); },
      articap::WriteHeadShapeCsv);
  return 0;
}
