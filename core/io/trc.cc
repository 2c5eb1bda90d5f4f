// SPDX-License-Identifier: MIT
// TRC, the track row column format of Motion Analysis, as OpenSim and others write it: a line of
// file type, a line of keys, a line of their values, marker names over every third column, X1 Y1
// Z1 ..., a blank line, rows.
#include <fmt/format.h>

#include <algorithm>

#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/sample_table.h"
#include "core/io/text.h"

namespace articap {
namespace {

struct TrcHeader {
  std::string unit;
  std::optional<double> rate_hz;
  std::optional<double> num_frames;
  std::optional<double> num_markers;
};

TrcHeader ParseHeader(const std::vector<std::string>& keys, const std::vector<std::string>& values,
                      std::vector<std::string>& warnings) {
  TrcHeader header;
  std::optional<double> camera_rate_hz;
  for (std::size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    const std::string key = ToLower(keys[i]);
    if (key == "datarate") header.rate_hz = ParseNumber(values[i]);
    if (key == "camerarate") camera_rate_hz = ParseNumber(values[i]);
    if (key == "numframes") header.num_frames = ParseNumber(values[i]);
    if (key == "nummarkers") header.num_markers = ParseNumber(values[i]);
    if (key == "units") header.unit = values[i];
  }
  if (!header.rate_hz) header.rate_hz = camera_rate_hz;
  if (values.size() < std::min<std::size_t>(keys.size(), 5))
    warnings.push_back(
        fmt::format("The header names {} keys but gives {} values.", keys.size(), values.size()));
  return header;
}

bool IsColumnRow(const std::vector<std::string>& cells) {
  return !cells.empty() && ToLower(cells[0]).starts_with("frame");
}

// Number of markers that the row "X1 Y1 Z1 X2 ..." has columns for.
std::size_t CountAxes(const std::vector<std::string>& cells) {
  std::size_t count = 0;
  for (const std::string& cell : cells)
    if (cell.size() > 1 && (cell[0] == 'X' || cell[0] == 'x') && cell[1] >= '0' && cell[1] <= '9')
      ++count;
  return count;
}

// Labels stand over the first of each three columns. Some programs forget the two tabs after each,
// and some end the row early.
std::vector<std::string> LabelsOf(const std::vector<std::string>& cells, std::size_t num_markers,
                                  std::vector<std::string>& warnings) {
  constexpr std::size_t kFirst = 2;  // after frame and time
  std::vector<std::string> given;
  bool is_spread = true;
  for (std::size_t i = kFirst; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    given.push_back(cells[i]);
    is_spread &= (i - kFirst) % 3 == 0;
  }
  std::vector<std::string> labels(num_markers);
  if (is_spread) {
    for (std::size_t k = 0; k < num_markers && kFirst + 3 * k < cells.size(); ++k)
      labels[k] = cells[kFirst + 3 * k];
  } else {
    warnings.push_back(
        "The marker names do not stand over their columns; they were taken in order.");
    std::copy_n(given.begin(), std::min(given.size(), num_markers), labels.begin());
  }
  if (given.size() > num_markers)
    warnings.push_back(fmt::format("The header names {} markers but has columns for {}.",
                                   given.size(), num_markers));
  return labels;
}

// How many markers there are, by whichever of names, axes and count the file has.
std::size_t CountMarkers(const TrcHeader& header, const std::vector<std::string>& names,
                         std::size_t num_axes, std::vector<std::string>& warnings) {
  const auto num_names = static_cast<std::size_t>(
      names.size() <= 2 ? 0
                        : std::count_if(names.begin() + 2, names.end(),
                                        [](const std::string& name) { return !name.empty(); }));
  const std::size_t count = num_axes > 0 ? num_axes : num_names;
  if (header.num_markers && *header.num_markers != static_cast<double>(count))
    warnings.push_back(fmt::format("The header promises {:g} markers, the columns are of {}.",
                                   *header.num_markers, count));
  return count;
}

}  // namespace

Result<MarkerRecording> ReadTrc(std::string_view text, const std::string& source_name,
                                const MarkerReadOptions& options) {
  std::vector<std::string> warnings;
  LineReader lines(text);
  TrcHeader header;
  std::vector<std::string> keys;
  std::vector<std::string> names;
  char delimiter = '\t';
  while (const auto line = lines.Next()) {
    delimiter = GuessDelimiter(*line);
    std::vector<std::string> cells = SplitCells(*line, delimiter);
    if (IsColumnRow(cells)) {
      names = std::move(cells);
      break;
    }
    if (!keys.empty()) {
      header = ParseHeader(keys, cells, warnings);
      keys.clear();
    } else if (line->find("DataRate") != std::string_view::npos) {
      keys = std::move(cells);
    }
    if (lines.line_number() > 20) break;
  }
  if (names.empty())
    return Fail(
        fmt::format("{}: there is no row \"Frame#, Time, marker names\" in the first lines; "
                    "this is not a TRC file, or it was cut short",
                    source_name));
  const LineReader after_names = lines;
  const auto axes = lines.Next();
  const std::size_t num_axes = axes ? CountAxes(SplitCells(*axes, delimiter)) : 0;
  if (num_axes == 0) lines = after_names;  // the rows begin here already

  TableLayout layout;
  layout.delimiter = delimiter;
  layout.frame_column = 0;
  layout.time_column = 1;
  const std::size_t num_markers = CountMarkers(header, names, num_axes, warnings);
  layout.labels = LabelsOf(names, num_markers, warnings);
  for (int k = 0; k < static_cast<int>(num_markers); ++k)
    layout.marker_columns.push_back({2 + 3 * k, 3 + 3 * k, 4 + 3 * k});
  layout.unit = header.unit;
  layout.rate_hz = header.rate_hz;
  layout.promised_frames = header.num_frames;
  return ReadSamples(lines, layout, source_name, options, std::move(warnings));
}

std::string WriteTrc(const MarkerRecording& recording) {
  const StageTracks& tracks = recording.tracks;
  const std::string rate = FormatRate(tracks.rate_hz());
  std::string out = fmt::format(
      "PathFileType\t4\t(X/Y/Z)\tmarkers.trc\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
      "OrigNumFrames\n"
      "{}\t{}\t{}\t{}\tmm\t{}\t{}\t{}\n"
      "Frame#\tTime",
      rate, rate, tracks.num_frames(), tracks.num_markers(), rate,
      tracks.num_frames() > 0 ? tracks.first_frame() : 1, tracks.num_frames());
  const char* gap = "\t";
  for (const std::string& label : LabelsToWrite(recording)) {
    out += gap + QuoteCell(label, '\t');
    gap = "\t\t\t";
  }
  if (tracks.num_markers() > 0) out += "\t\t";
  out += "\n\t";
  for (int k = 1; k <= tracks.num_markers(); ++k) out += fmt::format("\tX{}\tY{}\tZ{}", k, k, k);
  out += "\n\n";
  AppendRows(tracks, RowStyle{.delimiter = '\t'}, out);
  return out;
}

}  // namespace articap
