// SPDX-License-Identifier: MIT
#include <array>
#include <span>

#include "core/io/marker_info.h"
#include "core/marker_io.h"
#include "fuzz/fuzz_input.h"

namespace articap {
namespace {

Result<MarkerRecording> Parse(const std::string& bytes) {
  // A unit for formats that name none; where a file names another, it is refused.
  const std::span<const char> characters(bytes.data(), bytes.size());
  if (auto recording = ParseMarkers(std::as_bytes(characters), "fuzz")) return recording;
  MarkerReadOptions options;
  options.unit = "mm";
  options.rate_hz = 100;
  return ParseMarkers(std::as_bytes(characters), "fuzz", options);
}

// What was read can be written in every format, and what was written is read and written the same
// again.
void Check(const MarkerRecording& recording) {
  constexpr std::array kFormats = {MarkerFormat::kC3d,         MarkerFormat::kTrc,
                                   MarkerFormat::kQualisysTsv, MarkerFormat::kNexusCsv,
                                   MarkerFormat::kMotiveCsv,   MarkerFormat::kPlainCsv};
  for (const MarkerFormat format : kFormats) {
    LossesOf(recording, format);
    const std::string written = FormatMarkers(recording, format);
    const auto again = Parse(written);
    if (again) Require(FormatMarkers(*again, format) == written);
  }
  Require(!DescribeRecording(recording, "fuzz").verdict.empty());
}

}  // namespace
}  // namespace articap

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto recording = articap::Parse(articap::TextOf(data, size));
  if (recording) articap::Check(*recording);
  return 0;
}
