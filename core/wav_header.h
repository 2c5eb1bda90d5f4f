// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

// What the header of a WAV file says of its samples.
struct WavHeader {
  enum class SampleKind : std::uint8_t { kInteger, kFloat };
  SampleKind sample_kind = SampleKind::kInteger;
  std::int64_t rate_hz = 0;
  int channels = 0;
  int bits = 0;                 // of a sample
  int bytes_per_frame = 0;      // of a sample of every channel
  std::int64_t data_start = 0;  // where the samples begin, in bytes from the start of the file
  std::int64_t frames = 0;      // that are there: fewer than promised in a file that was cut short
  std::vector<std::string> warnings;  // what does not fit the header, each a sentence

  double duration_s() const { return static_cast<double>(frames) / static_cast<double>(rate_hz); }
};

// Reads RIFF and RF64 with PCM or IEEE float samples, also in the extensible form. Other chunks are
// skipped; no sample is read. Refused: files that end before their samples begin, other codings,
// and sizes that contradict one another. A file that ends before its last sample is read with a
// warning, as recordings are that lost their end.
Result<WavHeader> ParseWavHeader(std::istream& stream, const std::string& source_name);
Result<WavHeader> ReadWavHeader(const std::filesystem::path& path);

// Whether these are the first bytes (12 or more) of a WAV file.
bool LooksLikeWav(std::string_view bytes);

}  // namespace articap
