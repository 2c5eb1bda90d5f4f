// SPDX-License-Identifier: MIT
// Qualisys TSV (3D data): lines of key, tab, values; then rows of x, y, z for each marker, before
// them the frame number and the time where the export's options asked for these. Always in mm.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/sample_table.h"
#include "core/io/text.h"

namespace articap {
namespace {

struct TsvHeader {
  std::optional<double> num_frames;
  std::optional<double> num_markers;
  std::optional<double> rate_hz;
  std::string data_included = "3D";
  std::vector<std::string> labels;
  std::vector<MarkerEvent> events;
  std::vector<std::string> columns;  // of the row "Frame, Time, ...", where there is one
};

// Whether a line belongs to the header: its first cell is a word.
bool IsHeaderLine(const std::vector<std::string>& cells) {
  if (cells.empty() || cells[0].empty()) return false;
  const char first = cells[0][0];
  return ((first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z')) &&
         ToLower(cells[0]) != "nan";
}

// EVENT, label, frame, time in s.
void ParseEvent(const std::vector<std::string>& cells, TsvHeader& header) {
  if (cells.size() < 4) return;
  const auto time_s = ParseNumber(cells[3]);
  if (!time_s || !IsUsableEventTime(*time_s)) return;
  MarkerEvent event;
  event.label = cells[1];
  event.time_s = *time_s;
  header.events.push_back(event);
}

void ParseHeaderLine(const std::vector<std::string>& cells, TsvHeader& header) {
  const std::string key = ToLower(cells[0]);
  const std::string value = cells.size() > 1 ? cells[1] : "";
  if (key == "no_of_frames") header.num_frames = ParseNumber(value);
  if (key == "no_of_markers") header.num_markers = ParseNumber(value);
  if (key == "frequency") header.rate_hz = ParseNumber(value);
  if (key == "data_included") header.data_included = value;
  if (key == "event") ParseEvent(cells, header);
  if (key == "marker_names") header.labels.assign(cells.begin() + 1, cells.end());
  if (key == "frame" || key == "time") header.columns = cells;
}

// Names, counted as the header counts them: the row of names may end in empty cells.
std::vector<std::string> LabelsOf(const TsvHeader& header, std::vector<std::string>& warnings) {
  constexpr double kMostMarkers = 65535;
  std::vector<std::string> labels = header.labels;
  const double promised = header.num_markers.value_or(0);
  while (!labels.empty() && labels.back().empty() && static_cast<double>(labels.size()) > promised)
    labels.pop_back();
  if (!header.num_markers || promised == static_cast<double>(labels.size())) return labels;
  warnings.push_back(
      fmt::format("The header promises {:g} markers and names {}.", promised, labels.size()));
  if (labels.empty() && promised > 0 && promised <= kMostMarkers)
    labels.resize(static_cast<std::size_t>(promised));
  return labels;
}

// Which columns come before the markers': told by the row of column names, else by the number of
// cells of the first row.
void FindLeadingColumns(const TsvHeader& header, std::string_view first_row, TableLayout& layout) {
  if (!header.columns.empty()) {
    for (int i = 0; i < std::min<int>(2, static_cast<int>(header.columns.size())); ++i) {
      if (ToLower(header.columns[i]) == "frame") layout.frame_column = i;
      if (ToLower(header.columns[i]) == "time") layout.time_column = i;
    }
    return;
  }
  std::vector<std::string> cells = SplitCells(first_row, '\t');
  const std::size_t num_coordinates = 3 * layout.labels.size();
  if (cells.size() == num_coordinates + 1 && cells.back().empty()) return;  // a tab at the end
  const std::size_t extra = cells.size() - std::min(cells.size(), num_coordinates);
  if (extra >= 2) {
    layout.frame_column = 0;
    layout.time_column = 1;
  } else if (extra == 1) {
    (cells[0].find('.') == std::string::npos ? layout.frame_column : layout.time_column) = 0;
  }
}

}  // namespace

Result<MarkerRecording> ReadQualisysTsv(std::string_view text, const std::string& source_name,
                                        const MarkerReadOptions& options) {
  std::vector<std::string> warnings;
  TsvHeader header;
  LineReader lines(text);
  LineReader rows = lines;
  std::string_view first_row;
  while (const auto line = lines.Next()) {
    const std::vector<std::string> cells = SplitCells(*line, '\t');
    if (IsHeaderLine(cells)) {
      ParseHeaderLine(cells, header);
      rows = lines;
    } else if (!Trim(*line).empty() || !header.labels.empty()) {
      first_row = *line;
      break;
    }
  }
  if (ToLower(header.data_included) != "3d")
    return Fail(fmt::format("{}: the file holds {} data; export the 3D data of the markers",
                            source_name, Printable(header.data_included)));
  TableLayout layout;
  layout.labels = LabelsOf(header, warnings);
  FindLeadingColumns(header, first_row, layout);
  const int first = (layout.frame_column ? 1 : 0) + (layout.time_column ? 1 : 0);
  for (int k = 0; k < static_cast<int>(layout.labels.size()); ++k)
    layout.marker_columns.push_back({first + 3 * k, first + 3 * k + 1, first + 3 * k + 2});
  layout.unit = options.unit.empty() ? "mm" : "";
  layout.rate_hz = header.rate_hz;
  layout.promised_frames = header.num_frames;
  auto recording = ReadSamples(rows, layout, source_name, options, std::move(warnings));
  if (recording) recording->events = std::move(header.events);
  return recording;
}

std::string WriteQualisysTsv(const MarkerRecording& recording) {
  const StageTracks& tracks = recording.tracks;
  std::string out = fmt::format(
      "NO_OF_FRAMES\t{}\nNO_OF_CAMERAS\t0\nNO_OF_MARKERS\t{}\nFREQUENCY\t{}\nNO_OF_ANALOG\t0\n"
      "ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nDATA_INCLUDED\t3D\n",
      tracks.num_frames(), tracks.num_markers(), FormatRate(tracks.rate_hz()));
  for (const MarkerEvent& event : UsableEvents(recording.events)) {
    const double frame = std::round(event.time_s * tracks.rate_hz()) + 1;
    out += fmt::format("EVENT\t{}\t{:.0f}\t", QuoteCell(CleanText(event.label), '\t'), frame);
    AppendSeconds(event.time_s, out);
    out += "\n";
  }
  std::string columns = "Frame\tTime";
  out += "MARKER_NAMES";
  for (const std::string& label : LabelsToWrite(recording)) {
    (out += '\t') += QuoteCell(label, '\t');
    for (const char* axis : {"X", "Y", "Z"})
      (columns += '\t') += QuoteCell(fmt::format("{} {}", label, axis), '\t');
  }
  out += "\n" + columns + "\n";
  AppendRows(tracks, RowStyle{.delimiter = '\t'}, out);
  return out;
}

}  // namespace articap
