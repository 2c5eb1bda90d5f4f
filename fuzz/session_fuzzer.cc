// SPDX-License-Identifier: MIT
#include "core/session.h"

#include "fuzz/fuzz_input.h"

// session.toml and take.toml; what is read of a take leads nowhere out of its folder.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using articap::ParseSessionInfo;
  using articap::ParseTakeInfo;
  const std::string text = articap::TextOf(data, size);
  articap::RequireRoundTrip(
      text, [](const std::string& toml) { return ParseSessionInfo(toml, "fuzz"); },
      articap::WriteSessionInfo);
  articap::RequireRoundTrip(
      text, [](const std::string& toml) { return ParseTakeInfo(toml, "fuzz"); },
      articap::WriteTakeInfo);
  if (const auto take = ParseTakeInfo(text, "fuzz")) {
    articap::Require(articap::IsSafeName(take->id));
    for (const articap::TakeFile& file : take->files)
      articap::Require(articap::IsSafeName(file.name) && file.digest.size_bytes >= 0);
  }
  articap::Require(articap::IsSafeName(articap::SafeNameOf(text)));
  return 0;
}
