// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/text.h"
#include "core/io/timing.h"
#include "core/marker_io.h"

namespace articap {

// Where the numbers of a text file's rows go: the common core of TRC, TSV and CSV.
struct TableLayout {
  char delimiter = '\t';
  std::optional<int> frame_column;
  std::optional<int> time_column;
  double seconds_per_time = 1;
  std::vector<std::string> labels;                 // of the markers, as in the file
  std::vector<std::array<int, 3>> marker_columns;  // of x, y, z; columns count from 0
  std::string unit;                                // of length; empty where the file has none
  std::optional<double> rate_hz;
  std::optional<double> promised_frames;
  bool ends_at_blank_line = false;  // other sections may follow
};

// Reads the rows that `lines` has left. A row's missing cells are missing samples.
Result<MarkerRecording> ReadSamples(LineReader& lines, const TableLayout& layout,
                                    const std::string& source_name,
                                    const MarkerReadOptions& options,
                                    std::vector<std::string> warnings);

// The three cells of a sample in mm, each after a delimiter; empty where it is missing. A sample
// that would print as 0 0 0, which readers take as missing, is moved by the last digit.
void AppendSample(const StageTracks& tracks, int frame, int marker, char delimiter,
                  std::string& out);
// Rows of frame number, time and samples, as `with_*` ask for, each ended by `end_of_line`.
struct RowStyle {
  char delimiter = '\t';
  bool with_frame = true;
  bool with_time = true;
  bool with_sub_frame = false;  // a column of zeros after the frame number
};
void AppendRows(const StageTracks& tracks, const RowStyle& style, std::string& out);

}  // namespace articap
