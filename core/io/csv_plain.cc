// SPDX-License-Identifier: MIT
// Plain CSV: one header row `frame,time_s,NAME_x_mm,NAME_y_mm,NAME_z_mm,...`, then rows. Read with
// many spellings of the columns: NAME_X, NAME.x, NAME x, NAME_x_cm, NAME_x (m), time, time_ms, ...
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/sample_table.h"
#include "core/io/text.h"
#include "core/io/units.h"

namespace articap {
namespace {

// A column such as "chin_x_mm".
struct CoordinateColumn {
  std::string marker;
  int axis = 0;
  std::string unit;  // empty where the column names none
};

// "time_s" -> "time", "s"; also "time [s]", "time (s)". No unit where there is none.
struct NameAndUnit {
  std::string name;
  std::string unit;
};

NameAndUnit SplitUnit(std::string_view text) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const std::size_t at = text.rfind(open);
    if (at != std::string_view::npos && text.back() == close)
      return {std::string(Trim(text.substr(0, at))),
              std::string(Trim(text.substr(at + 1, text.size() - at - 2)))};
  }
  const std::size_t at = text.rfind('_');
  if (at == std::string_view::npos) return {std::string(text), ""};
  return {std::string(text.substr(0, at)), std::string(text.substr(at + 1))};
}

std::optional<CoordinateColumn> SplitAxis(std::string_view text, std::string_view unit) {
  text = Trim(text);
  if (text.size() < 3) return std::nullopt;
  const char axis = static_cast<char>(text.back() | 0x20);
  const char separator = text[text.size() - 2];
  if (axis < 'x' || axis > 'z' || std::string_view("_. :-").find(separator) == std::string::npos)
    return std::nullopt;
  return CoordinateColumn{std::string(Trim(text.substr(0, text.size() - 2))), axis - 'x',
                          std::string(unit)};
}

std::optional<CoordinateColumn> ParseCoordinateColumn(std::string_view text) {
  const NameAndUnit split = SplitUnit(text);
  if (ParseLengthUnit(split.unit))
    if (auto column = SplitAxis(split.name, split.unit)) return column;
  return SplitAxis(text, "");
}

bool IsFrameColumn(std::string_view text) {
  const std::string name = ToLower(text);
  return name == "frame" || name == "frame#" || name == "frames" || name == "index" ||
         name == "field" || name == "frame number";
}

// Seconds per unit of a time column, nothing for other columns. Bare "time" and "t" are seconds.
std::optional<double> ParseTimeColumn(std::string_view text) {
  const std::string whole = ToLower(text);
  const NameAndUnit split = SplitUnit(whole);
  const auto is_time = [](std::string_view name) {
    return name == "time" || name == "t" || name == "timestamp" || name == "times";
  };
  if (is_time(whole)) return 1;
  if (!is_time(split.name)) return std::nullopt;
  for (const auto& [unit, seconds] : {std::pair<std::string_view, double>{"s", 1},
                                      {"sec", 1},
                                      {"seconds", 1},
                                      {"ms", 1e-3},
                                      {"milliseconds", 1e-3},
                                      {"us", 1e-6},
                                      {"ns", 1e-9}})
    if (split.unit == unit) return seconds;
  return std::nullopt;
}

struct PlainHeader {
  TableLayout layout;
  std::vector<std::string> ignored;
};

Result<PlainHeader> ParseHeader(const std::vector<std::string>& cells,
                                const std::string& source_name) {
  PlainHeader header;
  TableLayout& layout = header.layout;
  std::map<std::string, std::size_t> last_of_name;
  for (int column = 0; column < static_cast<int>(cells.size()); ++column) {
    const std::string& cell = cells[column];
    if (!layout.frame_column && IsFrameColumn(cell)) {
      layout.frame_column = column;
    } else if (const auto seconds = ParseTimeColumn(cell); seconds && !layout.time_column) {
      layout.time_column = column;
      layout.seconds_per_time = *seconds;
    } else if (const auto coordinate = ParseCoordinateColumn(cell)) {
      if (!coordinate->unit.empty()) {
        if (!layout.unit.empty() &&
            ParseLengthUnit(layout.unit)->name != ParseLengthUnit(coordinate->unit)->name)
          return Fail(
              fmt::format("{}: the columns are in several units ({} and {}); convert them "
                          "to one",
                          source_name, layout.unit, coordinate->unit));
        layout.unit = coordinate->unit;
      }
      // A second "chin_x" begins a second marker called "chin".
      const auto found = last_of_name.find(coordinate->marker);
      if (found == last_of_name.end() ||
          layout.marker_columns[found->second][coordinate->axis] >= 0) {
        last_of_name[coordinate->marker] = layout.labels.size();
        layout.labels.push_back(coordinate->marker);
        layout.marker_columns.push_back({-1, -1, -1});
      }
      layout.marker_columns[last_of_name[coordinate->marker]][coordinate->axis] = column;
    } else if (!cell.empty()) {
      header.ignored.push_back(cell);
    }
  }
  for (std::size_t k = 0; k < layout.labels.size(); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (layout.marker_columns[k][axis] < 0)
        return Fail(
            fmt::format("{}: marker {} has no {} column; the header must name NAME_x_mm, "
                        "NAME_y_mm and NAME_z_mm for each",
                        source_name, Printable(layout.labels[k]),
                        std::string(1, static_cast<char>('x' + axis))));
  return header;
}

}  // namespace

Result<MarkerRecording> ReadPlainCsv(std::string_view text, const std::string& source_name,
                                     const MarkerReadOptions& options) {
  LineReader lines(text);
  std::optional<std::string_view> line;
  while ((line = lines.Next()) && Trim(*line).empty()) {
  }
  if (!line) return Fail(fmt::format("{}: the file is empty", source_name));
  const char delimiter = GuessDelimiter(*line);
  auto header = ParseHeader(SplitCells(*line, delimiter), source_name);
  if (!header) return tl::unexpected(header.error());
  if (header->layout.labels.empty() && !header->layout.time_column && !header->layout.frame_column)
    return Fail(
        fmt::format("{}: this is none of the marker formats: no C3D, TRC, Qualisys TSV, "
                    "Nexus or Motive CSV, nor a CSV whose first row names columns "
                    "frame,time_s,NAME_x_mm,NAME_y_mm,NAME_z_mm,...",
                    source_name));
  header->layout.delimiter = delimiter;
  // Columns without any marker have no length and need no unit.
  if (header->layout.labels.empty()) header->layout.unit = "mm";
  std::vector<std::string> warnings;
  if (!header->ignored.empty())
    warnings.push_back(
        fmt::format("{} columns are no coordinates and were left out, the first "
                    "\"{}\".",
                    header->ignored.size(), Printable(header->ignored.front())));
  return ReadSamples(lines, header->layout, source_name, options, std::move(warnings));
}

std::string WritePlainCsv(const MarkerRecording& recording) {
  std::string out = "frame,time_s";
  for (const std::string& label : LabelsToWrite(recording))
    for (const char* axis : {"x", "y", "z"})
      (out += ',') += QuoteCell(fmt::format("{}_{}_mm", label, axis), ',');
  out += "\n";
  AppendRows(recording.tracks, RowStyle{.delimiter = ','}, out);
  return out;
}

}  // namespace articap
