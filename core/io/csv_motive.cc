// SPDX-License-Identifier: MIT
// CSV of OptiTrack Motive: a line of keys and values, a blank line, then header rows that say for
// every column its type, name, id and quantity, "Frame,Time (Seconds),X,Y,Z,...", rows.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/sample_table.h"
#include "core/io/text.h"

namespace articap {
namespace {

struct MotiveHeader {
  std::optional<double> rate_hz;
  std::optional<double> num_frames;
  std::string unit;
  std::vector<std::string> types;
  std::vector<std::string> names;
  std::vector<std::string> quantities;
  std::vector<std::string> axes;
};

void ParseKeys(const std::vector<std::string>& cells, MotiveHeader& header) {
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    const std::string key = ToLower(cells[i]);
    if (key == "export frame rate") header.rate_hz = ParseNumber(cells[i + 1]);
    if (key == "capture frame rate" && !header.rate_hz) header.rate_hz = ParseNumber(cells[i + 1]);
    if (key == "total exported frames") header.num_frames = ParseNumber(cells[i + 1]);
    if (key == "length units") header.unit = cells[i + 1];
  }
}

Result<MotiveHeader> ParseHeader(LineReader& lines, const std::string& source_name) {
  MotiveHeader header;
  while (const auto line = lines.Next()) {
    std::vector<std::string> cells = SplitCells(*line, ',');
    if (cells.empty()) continue;
    if (ToLower(cells[0]) == "format version") {
      ParseKeys(cells, header);
    } else if (ToLower(cells[0]) == "frame") {
      header.axes = std::move(cells);
      return header;
    } else if (cells.size() > 1 && cells[0].empty()) {
      const std::string key = ToLower(cells[1]);
      if (key == "type")
        header.types = std::move(cells);
      else if (key == "name")
        header.names = std::move(cells);
      else if (key.empty() || key == "position" || key == "rotation")
        header.quantities = std::move(cells);
    }
    if (lines.line_number() > 50) break;
  }
  return Fail(fmt::format(
      "{}: there is no row \"Frame,Time (Seconds),X,Y,Z,...\"; this is not a tracking export of "
      "Motive, or it was cut short",
      source_name));
}

std::string CellOf(const std::vector<std::string>& cells, std::size_t column) {
  return column < cells.size() ? cells[column] : "";
}

// Whether a column begins the position of a marker of one of the types.
bool BeginsMarker(const MotiveHeader& header, std::size_t column, bool reconstructed) {
  const std::string type = ToLower(CellOf(header.types, column));
  const bool has_type =
      reconstructed ? type == "marker" : type == "rigid body marker" || type == "bone marker";
  const std::string quantity = ToLower(CellOf(header.quantities, column));
  return has_type && (quantity == "position" || header.quantities.empty()) &&
         ToLower(CellOf(header.axes, column)) == "x" &&
         ToLower(CellOf(header.axes, column + 1)) == "y" &&
         ToLower(CellOf(header.axes, column + 2)) == "z";
}

// Reconstructed markers, and those that a rigid body or a skeleton solved for where the
// reconstruction of that name was not exported.
void FindColumns(const MotiveHeader& header, TableLayout& layout,
                 std::vector<std::string>& warnings) {
  std::unordered_set<std::string> taken;
  std::size_t used = 0;
  int solved = 0;
  for (const bool reconstructed : {true, false})
    for (std::size_t column = 2; column < header.axes.size(); ++column) {
      if (!BeginsMarker(header, column, reconstructed)) continue;
      const std::string name = CellOf(header.names, column);
      if (!reconstructed && taken.contains(name)) continue;
      solved += !reconstructed;
      taken.insert(name);
      const int x = static_cast<int>(column);
      layout.marker_columns.push_back({x, x + 1, x + 2});
      layout.labels.push_back(name);
      used += 3;
    }
  if (solved > 0)
    warnings.push_back(fmt::format(
        "{} markers are those that Motive solved for, not reconstructed ones.", solved));
  const std::size_t columns = header.axes.size() - std::min<std::size_t>(header.axes.size(), 2);
  if (used < columns)
    warnings.push_back(fmt::format(
        "{} columns (rigid bodies, bones, rotations, quality) were left out.", columns - used));
}

}  // namespace

Result<MarkerRecording> ReadMotiveCsv(std::string_view text, const std::string& source_name,
                                      const MarkerReadOptions& options) {
  std::vector<std::string> warnings;
  LineReader lines(text);
  const auto header = ParseHeader(lines, source_name);
  if (!header) return tl::unexpected(header.error());
  TableLayout layout;
  layout.delimiter = ',';
  layout.frame_column = 0;
  if (ToLower(CellOf(header->axes, 1)).starts_with("time")) layout.time_column = 1;
  layout.unit = header->unit;
  layout.rate_hz = header->rate_hz;
  layout.promised_frames = header->num_frames;
  FindColumns(*header, layout, warnings);
  return ReadSamples(lines, layout, source_name, options, std::move(warnings));
}

std::string WriteMotiveCsv(const MarkerRecording& recording) {
  const StageTracks& tracks = recording.tracks;
  std::string out = fmt::format(
      "Format Version,1.23,Take Name,articap,Capture Frame Rate,{0},Export Frame Rate,{0},"
      "Total Frames in Take,{1},Total Exported Frames,{1},Rotation Type,Quaternion,"
      "Length Units,Millimeters,Coordinate Space,Global\n\n",
      tracks.rate_hz(), tracks.num_frames());
  std::string types = ",Type";
  std::string names = ",Name";
  std::string ids = ",ID";
  std::string quantities = ",";
  std::string axes = "Frame,Time (Seconds)";
  int id = 0;
  for (const std::string& label : LabelsToWrite(recording)) {
    ++id;
    for (const char* axis : {"X", "Y", "Z"}) {
      types += ",Marker";
      (names += ',') += QuoteCell(label, ',');
      ids += fmt::format(",{}", id);
      quantities += ",Position";
      (axes += ",") += axis;
    }
  }
  for (const std::string* row : {&types, &names, &ids, &quantities, &axes}) out += *row + "\n";
  AppendRows(tracks, RowStyle{.delimiter = ','}, out);
  return out;
}

}  // namespace articap
