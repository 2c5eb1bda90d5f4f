// SPDX-License-Identifier: MIT
#include "capture/transport_stream.h"

#include <string_view>

#include "fuzz/fuzz_input.h"

// The packets where one file of a recording ends and the next begins.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = articap::TextOf(data, size);
  const std::string_view all(bytes);
  const bool goes_on = articap::TransportPacketsGoOn(all.substr(0, size / 2), all.substr(size / 2));
  articap::Require(!goes_on || size > 0);
  return 0;
}
