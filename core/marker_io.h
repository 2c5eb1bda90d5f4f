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
  // unit needs none, and one that names another is refused. Qualisys TSV names none because the
  // format is in mm by definition; this overrules it.
  std::string unit;
  // Overrules the unit that the file names, for files whose unit is wrong; a warning says so.
  std::string force_unit;
  // Frames a second, where the file holds neither a rate nor times; a file that holds another is
  // refused.
  std::optional<double> rate_hz;
  // Text formats have no agreed sign for "not seen": besides empty cells, nan and the like, a
  // marker at exactly 0 0 0 is taken as missing (and counted in a warning), in C3D where the
  // residual is 0 too. Switch it off for data that are relative to a marker, which then sits at the
  // origin.
  bool zero_is_missing = true;
};

// Reads any of the formats, told apart by content, then by extension. Positions become mm. Refused:
// unknown units, files that hold no markers of that kind, rates of zero without times. Everything
// that had to be repaired is in `warnings` of the recording. Rules that all formats share:
// - Duplicate names get "_2", "_3", ...; markers without a name become "unlabelled_N" (N from 1).
// - A subject that all names begin with ("Anna:chin") is taken off into `subject`.
// - Where a rate and a time column disagree, the time column wins, with a warning. Frames that a
//   file leaves out become missing samples. The first frame's time is the time column's, else
//   (first frame - 1) / rate, or 0 for a first frame below 1.
Result<MarkerRecording> ReadMarkers(const std::filesystem::path& path,
                                    const MarkerReadOptions& options = {});
Result<MarkerRecording> ParseMarkers(std::span<const std::byte> bytes,
                                     const std::string& source_name,
                                     const MarkerReadOptions& options = {});

// Which limit of the format the recording exceeds, so that it cannot be written at all; or nothing.
std::optional<std::string> LimitExceeded(const MarkerRecording& recording, MarkerFormat format);

// The bytes of a file of that format, whose limits must hold; write(read(write(x))) equals write(x)
// byte for byte.
std::string FormatMarkers(const MarkerRecording& recording, MarkerFormat format);

// What the format cannot carry of this recording, each a sentence; empty where nothing is lost.
std::vector<std::string> LossesOf(const MarkerRecording& recording, MarkerFormat format);

// Whether a face or head was recorded, judged by size alone: what is wrong and which unit it looks
// like, or nothing. For the stages that need a face; any recording may be read and converted.
std::optional<std::string> ImplausibleSize(const MarkerRecording& recording);

// Which format a file name asks for: .c3d, .trc, .tsv, .csv (plain; "nexus.csv" and "motive.csv"
// endings for those layouts).
Result<MarkerFormat> MarkerFormatOf(const std::filesystem::path& path);

}  // namespace articap
