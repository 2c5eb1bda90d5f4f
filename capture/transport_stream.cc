// SPDX-License-Identifier: MIT
#include "capture/transport_stream.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>

namespace articap {
namespace {

constexpr std::size_t kPacketBytes = 188;
constexpr char kSync = 0x47;

// Packets come as they are, or each with a time stamp of 4 bytes before it (Blu-ray, AVCHD).
struct Layout {
  std::size_t first = 0;
  std::size_t step = kPacketBytes;
};

std::optional<Layout> FindLayout(std::string_view bytes) {
  constexpr std::size_t kSyncsNeeded = 5;
  for (const std::size_t step : {kPacketBytes, kPacketBytes + 4})
    for (std::size_t first = 0; first < step; ++first) {
      std::size_t found = 0;
      while (found < kSyncsNeeded && first + found * step < bytes.size() &&
             bytes[first + found * step] == kSync)
        ++found;
      if (found == kSyncsNeeded) return Layout{first, step};
    }
  return std::nullopt;
}

struct Counters {
  std::map<int, int> first, last;  // by stream (PID)
};

Counters CountersOf(std::string_view bytes) {
  constexpr int kPadding = 0x1FFF;
  Counters counters;
  const auto layout = FindLayout(bytes);
  if (!layout) return counters;
  for (std::size_t at = layout->first; at + kPacketBytes <= bytes.size(); at += layout->step) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[at + i]); };
    const int stream = (byte(1) & 0x1F) << 8 | byte(2);
    const bool has_payload = (byte(3) & 0x10) != 0;  // the others are not counted
    if (bytes[at] != kSync || stream == kPadding || !has_payload) continue;
    counters.first.emplace(stream, byte(3) & 0x0F);
    counters.last[stream] = byte(3) & 0x0F;
  }
  return counters;
}

std::string BytesOf(const std::filesystem::path& path, bool from_end) {
  constexpr std::streamoff kMost = 1 << 20;
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = std::max<std::streamoff>(stream.tellg(), 0);
  std::string bytes(static_cast<std::size_t>(std::min(size, kMost)), '\0');
  stream.seekg(from_end ? size - static_cast<std::streamoff>(bytes.size()) : 0);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

}  // namespace

bool TransportPacketsGoOn(std::string_view end_of_first, std::string_view start_of_second) {
  const Counters before = CountersOf(end_of_first);
  const Counters after = CountersOf(start_of_second);
  bool any_in_common = false;
  for (const auto& [stream, last] : before.last) {
    const auto next = after.first.find(stream);
    if (next == after.first.end()) continue;
    any_in_common = true;
    if (next->second != (last + 1) % 16) return false;
  }
  return any_in_common;
}

bool TransportStreamGoesOn(const std::filesystem::path& first,
                           const std::filesystem::path& second) {
  return TransportPacketsGoOn(BytesOf(first, true), BytesOf(second, false));
}

}  // namespace articap
