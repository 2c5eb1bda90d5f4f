// SPDX-License-Identifier: MIT
#include "fuzz/camera_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  articap::RequireCamerasToRoundTrip(articap::TextOf(data, size), "session.qca.txt");
  return 0;
}
