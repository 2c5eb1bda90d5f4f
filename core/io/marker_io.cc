// SPDX-License-Identifier: MIT
#include "core/marker_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/check.h"
#include "core/file_io.h"
#include "core/io/c3d_bytes.h"
#include "core/io/formats.h"
#include "core/io/text.h"

namespace articap {
namespace {

std::string_view AsText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The key byte, and a parameter section with a processor where the first byte points to.
bool LooksLikeC3d(std::span<const std::byte> bytes) {
  if (bytes.size() < 2 || std::to_integer<int>(bytes[1]) != kC3dKey) return false;
  const auto block = std::to_integer<std::size_t>(bytes[0]);
  if (block < 32) return true;  // no text begins like this
  const std::size_t processor = (block - 1) * kC3dBlockBytes + 3;
  return processor < bytes.size() && std::to_integer<int>(bytes[processor]) >= 84 &&
         std::to_integer<int>(bytes[processor]) <= 86;
}

// By what the first lines say.
std::optional<MarkerFormat> GuessFromText(std::string_view text) {
  constexpr int kManyLines = 2000;  // Nexus files may begin with other sections
  LineReader lines(text);
  for (int i = 0; i < kManyLines; ++i) {
    const auto line = lines.Next();
    if (!line) break;
    const std::string start = ToLower(Trim(line->substr(0, 200)));
    if (start.starts_with("pathfiletype") || start.starts_with("datarate"))
      return MarkerFormat::kTrc;
    if (start.starts_with("file_version") || start.starts_with("no_of_frames") ||
        start.starts_with("no_of_cameras") || start.starts_with("no_of_markers") ||
        start.starts_with("marker_names"))
      return MarkerFormat::kQualisysTsv;
    if (start.starts_with("format version") || start.starts_with(",type,"))
      return MarkerFormat::kMotiveCsv;
    if (start.starts_with("trajectories")) return MarkerFormat::kNexusCsv;
  }
  return std::nullopt;
}

}  // namespace

const char* NameOf(MarkerFormat format) {
  switch (format) {
    case MarkerFormat::kC3d:
      return "c3d";
    case MarkerFormat::kTrc:
      return "trc";
    case MarkerFormat::kQualisysTsv:
      return "tsv";
    case MarkerFormat::kNexusCsv:
      return "nexus";
    case MarkerFormat::kMotiveCsv:
      return "motive";
    case MarkerFormat::kPlainCsv:
      return "csv";
  }
  return "unknown";
}

Result<MarkerFormat> MarkerFormatOf(const std::filesystem::path& path) {
  static constexpr std::array<std::pair<std::string_view, MarkerFormat>, 6> kEndings = {
      {{".c3d", MarkerFormat::kC3d},
       {".trc", MarkerFormat::kTrc},
       {".tsv", MarkerFormat::kQualisysTsv},
       {"nexus.csv", MarkerFormat::kNexusCsv},
       {"motive.csv", MarkerFormat::kMotiveCsv},
       {".csv", MarkerFormat::kPlainCsv}}};
  const std::string name = ToLower(path.filename().string());
  for (const auto& [ending, format] : kEndings)
    if (name.ends_with(ending)) return format;
  return Fail(
      fmt::format("{}: no marker format has this ending; use .c3d, .trc, .tsv, .csv, "
                  "nexus.csv or motive.csv",
                  path.string()));
}

Result<MarkerRecording> ReadMarkers(const std::filesystem::path& path,
                                    const MarkerReadOptions& options) {
  const auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  return ParseMarkers(std::as_bytes(std::span(*bytes)), path.string(), options);
}

Result<MarkerRecording> ParseMarkers(std::span<const std::byte> bytes,
                                     const std::string& source_name,
                                     const MarkerReadOptions& options) {
  const std::string_view text = AsText(bytes);
  if (text.find_first_not_of(std::string_view(" \t\r\n\0", 5)) == std::string_view::npos)
    return Fail(fmt::format("{}: the file is empty", source_name));
  if (LooksLikeC3d(bytes)) return ReadC3d(bytes, source_name, options);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return Fail(fmt::format("{}: the text is UTF-16; save it as UTF-8", source_name));
  auto format = GuessFromText(text);
  if (!format) {
    const auto by_ending = MarkerFormatOf(source_name);
    format = by_ending ? *by_ending : MarkerFormat::kPlainCsv;
  }
  switch (*format) {
    case MarkerFormat::kC3d:
      return Fail(
          fmt::format("{}: this is not a C3D file, or its first bytes are damaged", source_name));
    case MarkerFormat::kTrc:
      return ReadTrc(text, source_name, options);
    case MarkerFormat::kQualisysTsv:
      return ReadQualisysTsv(text, source_name, options);
    case MarkerFormat::kNexusCsv:
      return ReadNexusCsv(text, source_name, options);
    case MarkerFormat::kMotiveCsv:
      return ReadMotiveCsv(text, source_name, options);
    case MarkerFormat::kPlainCsv:
      return ReadPlainCsv(text, source_name, options);
  }
  return Fail(source_name + ": unknown format");
}

std::optional<std::string> LimitExceeded(const MarkerRecording& recording, MarkerFormat format) {
  return format == MarkerFormat::kC3d ? C3dLimitExceeded(recording) : std::nullopt;
}

std::string FormatMarkers(const MarkerRecording& recording, MarkerFormat format) {
  const StageTracks& tracks = recording.tracks;
  const std::size_t num_samples =
      static_cast<std::size_t>(tracks.num_frames()) * tracks.num_markers();
  ARTICAP_CHECK(recording.residuals_mm.empty() || recording.residuals_mm.size() == num_samples);
  ARTICAP_CHECK(recording.camera_masks.empty() || recording.camera_masks.size() == num_samples);
  ARTICAP_CHECK(recording.descriptions.empty() ||
                recording.descriptions.size() == tracks.names().size());
  for (const AnalogChannel& channel : recording.analog.channels)
    ARTICAP_CHECK_EQ(channel.samples.size(), static_cast<std::size_t>(tracks.num_frames()) *
                                                 recording.analog.samples_per_frame);
  switch (format) {
    case MarkerFormat::kC3d:
      return WriteC3d(recording);
    case MarkerFormat::kTrc:
      return WriteTrc(recording);
    case MarkerFormat::kQualisysTsv:
      return WriteQualisysTsv(recording);
    case MarkerFormat::kNexusCsv:
      return WriteNexusCsv(recording);
    case MarkerFormat::kMotiveCsv:
      return WriteMotiveCsv(recording);
    case MarkerFormat::kPlainCsv:
      return WritePlainCsv(recording);
  }
  return {};
}

}  // namespace articap
