// SPDX-License-Identifier: MIT
// CSV of Vicon Nexus: sections, of which "Trajectories" holds the markers: the rate, the names over
// every third column, "Frame,Sub Frame,X,Y,Z,...", units, rows up to a blank line.
#include <fmt/format.h>

#include <algorithm>

#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/sample_table.h"
#include "core/io/text.h"
#include "core/io/units.h"

namespace articap {
namespace {

// The rows above the numbers of the section.
struct NexusHeader {
  std::optional<double> rate_hz;
  std::vector<std::string> names;
  std::vector<std::string> columns;
  std::vector<std::string> units;
};

// Moves behind the line "Trajectories". Sections before it are named in a warning.
bool FindTrajectories(LineReader& lines, std::vector<std::string>& warnings) {
  bool begins_section = true;
  while (const auto line = lines.Next()) {
    const std::vector<std::string> cells = SplitCells(*line, ',');
    const std::string first = cells.empty() ? "" : cells[0];
    if (ToLower(first) == "trajectories") return true;
    const bool is_blank = std::all_of(cells.begin(), cells.end(),
                                      [](const std::string& cell) { return cell.empty(); });
    if (begins_section && !is_blank)
      warnings.push_back(fmt::format("The section \"{}\" was left out.", Printable(first)));
    begins_section = is_blank;
  }
  return false;
}

Result<NexusHeader> ParseHeader(LineReader& lines, const std::string& source_name) {
  NexusHeader header;
  const auto rate = lines.Next();
  if (rate) {
    const std::vector<std::string> cells = SplitCells(*rate, ',');
    if (!cells.empty()) header.rate_hz = ParseNumber(cells[0]);
  }
  for (auto* row : {&header.names, &header.columns, &header.units})
    if (const auto line = lines.Next()) *row = SplitCells(*line, ',');
  if (header.columns.empty() || ToLower(header.columns[0]) != "frame")
    return Fail(fmt::format(
        "{}, line {}: the section Trajectories should go on with its rate, the marker names, "
        "\"Frame,Sub Frame,X,Y,Z,...\" and the units; it does not",
        source_name, lines.line_number()));
  return header;
}

Result<TableLayout> FindColumns(const NexusHeader& header, const std::string& source_name,
                                std::vector<std::string>& warnings) {
  TableLayout layout;
  layout.delimiter = ',';
  layout.frame_column = 0;
  layout.rate_hz = header.rate_hz;
  layout.ends_at_blank_line = true;
  const auto axis_at = [&](std::size_t column) {
    return column < header.columns.size() ? ToLower(header.columns[column]) : "";
  };
  int left_out = 0;
  for (std::size_t column = 2; column < header.columns.size(); ++column) {
    if (axis_at(column) == "x" && axis_at(column + 1) == "y" && axis_at(column + 2) == "z") {
      const int x = static_cast<int>(column);
      layout.marker_columns.push_back({x, x + 1, x + 2});
      layout.labels.push_back(column < header.names.size() ? header.names[column] : "");
      for (std::size_t k = column; k < column + 3 && k < header.units.size(); ++k) {
        const std::string& unit = header.units[k];
        if (unit.empty()) continue;
        if (!layout.unit.empty() && unit != layout.unit)
          return Fail(fmt::format("{}: the columns are in several units ({} and {})", source_name,
                                  Printable(layout.unit), Printable(unit)));
        layout.unit = unit;
      }
      column += 2;
    } else {
      left_out += !header.columns[column].empty();
    }
  }
  if (left_out > 0)
    warnings.push_back(fmt::format(
        "{} columns are no positions (velocities, for example) and were left out.", left_out));
  if (layout.labels.empty() && layout.unit.empty()) layout.unit = "mm";  // of nothing
  return layout;
}

}  // namespace

Result<MarkerRecording> ReadNexusCsv(std::string_view text, const std::string& source_name,
                                     const MarkerReadOptions& options) {
  std::vector<std::string> warnings;
  LineReader lines(text);
  if (!FindTrajectories(lines, warnings))
    return Fail(fmt::format("{}: there is no section \"Trajectories\"; export the trajectories",
                            source_name));
  const auto header = ParseHeader(lines, source_name);
  if (!header) return tl::unexpected(header.error());
  const auto layout = FindColumns(*header, source_name, warnings);
  if (!layout) return tl::unexpected(layout.error());
  return ReadSamples(lines, *layout, source_name, options, std::move(warnings));
}

std::string WriteNexusCsv(const MarkerRecording& recording) {
  const StageTracks& tracks = recording.tracks;
  std::string names = ",";
  std::string columns = "Frame,Sub Frame";
  std::string units = ",";
  const char* gap = ",";
  for (const std::string& label : LabelsToWrite(recording)) {
    names += gap + QuoteCell(label, ',');
    columns += ",X,Y,Z";
    units += ",mm,mm,mm";
    gap = ",,,";
  }
  if (tracks.num_markers() > 0) names += ",,";
  std::string out =
      fmt::format("Trajectories\n{}\n{}\n{}\n{}\n", tracks.rate_hz(), names, columns, units);
  AppendRows(tracks, RowStyle{.delimiter = ',', .with_time = false, .with_sub_frame = true}, out);
  return out;
}

}  // namespace articap
