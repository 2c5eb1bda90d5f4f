// SPDX-License-Identifier: MIT
#include "core/wav_header.h"

#include <sstream>

#include "fuzz/fuzz_input.h"

// The samples that a header speaks of lie in the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream stream(articap::TextOf(data, size));
  const auto header = articap::ParseWavHeader(stream, "fuzz");
  if (!header) {
    articap::Require(!header.error().message.empty());
    return 0;
  }
  articap::Require(header->channels > 0 && header->rate_hz > 0 && header->bits > 0);
  articap::Require(header->frames >= 0 && header->data_start >= 0);
  articap::Require(header->data_start + header->frames * header->bytes_per_frame <=
                   static_cast<std::int64_t>(size));
  return 0;
}
