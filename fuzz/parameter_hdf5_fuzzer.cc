// SPDX-License-Identifier: MIT
#include "core/parameter_track.h"

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const articap::TemporaryFile file(data, size, ".h5");
  const auto track = articap::ReadParameterHdf5(file.path());
  if (track) articap::Require(track->values.cols() == static_cast<int>(track->names.size()));
  return 0;
}
