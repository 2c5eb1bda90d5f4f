// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/marker_recording.h"
#include "core/result.h"

namespace articap {

enum class MarkerFormat : std::uint8_t {
  kC3d,
  kTrc,
  kQualisysTsv,
  kNexusCsv,
  kMotiveCsv,
  kPlainCsv
};
const char* NameOf(MarkerFormat format);  // "c3d", "trc", "tsv", "nexus", "motive", "csv"

struct MarkerReadOptions {
  // Unit of length, where the file names none ("mm", "cm", "m", "um", "in"). A file that names its
  // unit needs none, and one that names another is refused.
  std::string unit;
  // Frames a second, where the file holds neither a rate nor times.
  std::optional<double> rate_hz;
};

// Reads any of the formats, told apart by content, then by extension. Positions become mm. Refused:
// unknown units, a size that no face has (with the unit it looks like), rates of zero.
Result<MarkerRecording> ReadMarkers(const std::filesystem::path& path,
                                    const MarkerReadOptions& options = {});
Result<MarkerRecording> ParseMarkers(std::span<const std::byte> bytes,
                                     const std::string& source_name,
                                     const MarkerReadOptions& options = {});

// The bytes of a file of that format; write(read(write(x))) equals write(x) byte for byte.
std::string FormatMarkers(const MarkerRecording& recording, MarkerFormat format);

// What the format cannot carry of this recording, each a sentence; empty where nothing is lost.
std::vector<std::string> LossesOf(const MarkerRecording& recording, MarkerFormat format);

// Which format a file name asks for: .c3d, .trc, .tsv, .csv (plain; "nexus.csv" and "motive.csv"
// endings for those layouts).
Result<MarkerFormat> MarkerFormatOf(const std::filesystem::path& path);

}  // namespace articap
