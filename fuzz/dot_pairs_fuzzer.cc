// SPDX-License-Identifier: MIT
#include "calib/mirror_dots.h"
#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto dots = articap::ParseDotPairs(articap::TextOf(data, size), "dots.csv");
  if (!dots) return 0;
  // What was read is finite, and what can be solved is so without a crash.
  for (const articap::DotPair& dot : *dots)
    if (!dot.direct_px.allFinite() || !dot.mirrored_px.allFinite()) __builtin_trap();
  articap::Camera camera;
  camera.width = 1280;
  camera.height = 720;
  camera.lens = {1500, 1500, 640, 360, {}};
  articap::MirrorDotsOptions options;
  options.length_from = "a";
  options.length_to = "b";
  options.length_mm = 100;
  (void)articap::CalibrateMirrorFromDots(camera, *dots, options);
  return 0;
}
