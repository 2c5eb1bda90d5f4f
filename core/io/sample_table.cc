// SPDX-License-Identifier: MIT
#include "core/io/sample_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/io/marker_names.h"
#include "core/io/units.h"

namespace articap {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What a column's number is: a coordinate (3 * marker + axis), or one of these.
enum Target : int { kIgnored = -1, kFrameNumber = -2, kTime = -3 };

// The rows of a table as numbers.
struct Rows {
  std::vector<double> coordinates;  // rows x markers x 3, NaN where empty
  std::vector<double> frame_numbers;
  std::vector<double> times;
  std::size_t count = 0;
  int time_decimals = 0;
  std::size_t not_finite = 0;  // samples that say nan, inf, and the like
  std::size_t short_rows = 0;
  bool last_was_cut = false;
  bool more_follows = false;  // behind the blank line that ended the table
};

// What programs write where they have no number.
bool SaysMissing(std::string_view cell) {
  static constexpr std::array<std::string_view, 12> kWords = {
      "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "*", "-nan", "nan(ind)", "-nan(ind)"};
  const std::string lower = ToLower(cell);
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end() ||
         lower.find("1.#") != std::string::npos;
}

std::string_view Unquote(std::string_view cell) {
  cell = Trim(cell);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    cell = Trim(cell.substr(1, cell.size() - 2));
  return cell;
}

// Digits behind the point: 3 for "1.250", 5 for "1.250e-2".
int CountDecimals(std::string_view cell) {
  const std::size_t exponent_at = std::min(cell.find_first_of("eE"), cell.size());
  const std::size_t point = std::min(cell.find_first_of(".,"), exponent_at);
  const auto decimals = static_cast<int>(exponent_at - std::min(point + 1, exponent_at));
  if (exponent_at == cell.size()) return decimals;
  const double exponent = ParseNumber(cell.substr(exponent_at + 1)).value_or(0);
  return decimals - static_cast<int>(std::clamp(exponent, -20.0, 20.0));
}

class RowParser {
 public:
  RowParser(const TableLayout& layout, const std::string& source_name)
      : layout_(layout), source_name_(source_name) {
    for (std::size_t marker = 0; marker < layout.marker_columns.size(); ++marker)
      for (std::size_t axis = 0; axis < 3; ++axis)
        Aim(layout.marker_columns[marker][axis], static_cast<int>(3 * marker + axis));
    if (layout.frame_column) Aim(*layout.frame_column, kFrameNumber);
    if (layout.time_column) Aim(*layout.time_column, kTime);
    row_.assign(3 * layout.marker_columns.size(), kNone);
  }

  // Appends the line's row, unless it is blank.
  Result<void> Parse(std::string_view line, int line_number, Rows& rows) {
    std::size_t column = 0;
    bool is_blank = true;
    const char* at = line.data();
    const char* const end = at + line.size();
    while (at <= end && column < targets_.size()) {
      const std::string_view cell = NextCell(at, end);
      if (!cell.empty()) {
        is_blank = false;
        if (targets_[column] != kIgnored)
          if (const auto stored = Store(cell, column, line_number, rows); !stored) return stored;
      }
      ++column;
    }
    if (is_blank) return {};
    rows.short_rows += column < targets_.size();
    rows.coordinates.insert(rows.coordinates.end(), row_.begin(), row_.end());
    if (layout_.frame_column) rows.frame_numbers.push_back(frame_number_);
    if (layout_.time_column) rows.times.push_back(time_ * layout_.seconds_per_time);
    ++rows.count;
    std::fill(row_.begin(), row_.end(), kNone);
    frame_number_ = time_ = kNone;
    return {};
  }

  std::size_t num_columns() const { return targets_.size(); }

 private:
  void Aim(int column, int target) {
    if (column >= static_cast<int>(targets_.size())) targets_.resize(column + 1, kIgnored);
    targets_[column] = target;
  }

  // The cell at `at`, which moves behind its delimiter, or beyond `end` after the last.
  std::string_view NextCell(const char*& at, const char* end) const {
    if (layout_.delimiter == ' ')
      while (at < end && (*at == ' ' || *at == '\t')) ++at;
    const char* const begin = at;
    while (at < end && *at != layout_.delimiter && !(layout_.delimiter == ' ' && *at == '\t')) ++at;
    const std::string_view cell(begin, static_cast<std::size_t>(at - begin));
    ++at;
    return Unquote(cell);
  }

  Result<void> Store(std::string_view cell, std::size_t column, int line_number, Rows& rows) {
    const int target = targets_[column];
    auto number = ParseNumber(cell);
    if (!number && SaysMissing(cell)) number = kNone;
    if (!number)
      return Fail(
          fmt::format("{}, line {}, column {}{}: \"{}\" is not a number; repair the cell or "
                      "leave it empty",
                      source_name_, line_number, column + 1, Describe(target), Printable(cell)));
    if (target == kFrameNumber) {
      frame_number_ = *number;
    } else if (target == kTime) {
      time_ = *number;
      rows.time_decimals = std::max(rows.time_decimals, CountDecimals(cell));
    } else if (std::isfinite(*number)) {
      row_[target] = *number;
    } else {
      ++rows.not_finite;
    }
    return {};
  }

  std::string Describe(int target) const {
    if (target < 0) return target == kTime ? " (time)" : " (frame number)";
    return fmt::format(" (marker {})", Printable(layout_.labels[target / 3]));
  }

  const TableLayout& layout_;
  const std::string& source_name_;
  std::vector<int> targets_;
  std::vector<double> row_;
  double frame_number_ = kNone;
  double time_ = kNone;
};

Result<Rows> ReadRows(LineReader& lines, const TableLayout& layout,
                      const std::string& source_name) {
  Rows rows;
  RowParser parser(layout, source_name);
  std::size_t num_bytes = 0;
  while (const auto line = lines.Next()) {
    // The last line of a file that was cut may end within a number: it is not a row.
    const auto cells =
        1 + static_cast<std::size_t>(std::count(line->begin(), line->end(), layout.delimiter));
    if (!lines.line_was_ended() && layout.delimiter != ' ' && cells < parser.num_columns() &&
        !Trim(*line).empty()) {
      rows.last_was_cut = true;
      break;
    }
    num_bytes += line->size() + 1;
    if (layout.ends_at_blank_line && Trim(*line).empty() && rows.count > 0) {
      rows.more_follows = lines.Next().has_value();
      break;
    }
    if (const auto parsed = parser.Parse(*line, lines.line_number(), rows); !parsed)
      return tl::unexpected(parsed.error());
    // A row of a few bytes under a header of thousands of columns must not cost thousands of cells.
    if (rows.coordinates.size() > 1000000 && rows.coordinates.size() > 64 * num_bytes)
      return Fail(fmt::format(
          "{}, line {}: the rows are far shorter than the {} columns that the header announces",
          source_name, lines.line_number(), parser.num_columns()));
  }
  return rows;
}

// A number that is missing in some rows is no use as a clock.
bool AllFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

TimingClues CluesOf(Rows& rows, const TableLayout& layout, std::vector<std::string>& warnings) {
  TimingClues clues;
  clues.rate_hz = layout.rate_hz;
  if (AllFinite(rows.frame_numbers))
    clues.frame_numbers = std::move(rows.frame_numbers);
  else
    warnings.push_back("Some rows have no frame number; the rows were counted instead.");
  if (AllFinite(rows.times))
    clues.times_s = std::move(rows.times);
  else
    warnings.push_back("Some rows have no time; the time column was ignored.");
  const int shift = static_cast<int>(std::lround(-std::log10(layout.seconds_per_time)));
  clues.time_decimals = std::clamp(rows.time_decimals + shift, 0, 9);
  return clues;
}

void PlaceSamples(const Rows& rows, const Timing& timing, double mm_per_unit, bool zero_is_missing,
                  StageTracks& tracks, std::vector<std::string>& warnings) {
  std::size_t incomplete = 0;
  std::size_t at_zero = 0;
  const double* coordinates = rows.coordinates.data();
  for (std::size_t row = 0; row < rows.count; ++row) {
    for (int marker = 0; marker < tracks.num_markers(); ++marker, coordinates += 3) {
      const Eigen::Vector3d position = Eigen::Map<const Eigen::Vector3d>(coordinates) * mm_per_unit;
      if (zero_is_missing && position.isZero(0))
        ++at_zero;
      else if (position.allFinite())
        tracks.Set(timing.frame_of_row[row], marker, position);
      else if (!position.array().isNaN().all())
        ++incomplete;
    }
  }
  if (at_zero > 0)
    warnings.push_back(
        fmt::format("{} samples are exactly 0 0 0; they count as missing.", at_zero));
  if (incomplete > 0)
    warnings.push_back(fmt::format(
        "{} samples lack one or two of x, y and z; they count as missing.", incomplete));
}

void WarnOfRows(const Rows& rows, const TableLayout& layout, std::vector<std::string>& warnings) {
  if (rows.last_was_cut) warnings.push_back("The last row was cut short; it was left out.");
  if (rows.more_follows)
    warnings.push_back(
        fmt::format("What follows the {} rows behind a blank line was left out.", rows.count));
  if (rows.short_rows > 0)
    warnings.push_back(fmt::format(
        "{} rows have fewer cells than the header announces; what they lack is missing.",
        rows.short_rows));
  if (rows.not_finite > 0)
    warnings.push_back(fmt::format(
        "{} coordinates are not finite numbers; their samples count as missing.", rows.not_finite));
  if (layout.promised_frames && *layout.promised_frames != static_cast<double>(rows.count))
    warnings.push_back(fmt::format("The header promises {:g} frames, the file has {} rows.",
                                   *layout.promised_frames, rows.count));
}

}  // namespace

Result<MarkerRecording> ReadSamples(LineReader& lines, const TableLayout& layout,
                                    const std::string& source_name,
                                    const MarkerReadOptions& options,
                                    std::vector<std::string> warnings) {
  MarkerRecording recording;
  recording.warnings = std::move(warnings);
  const auto unit = ResolveUnit(layout.unit, options, source_name, recording.warnings);
  if (!unit) return tl::unexpected(unit.error());
  recording.source_unit = unit->name;
  auto rows = ReadRows(lines, layout, source_name);
  if (!rows) return tl::unexpected(rows.error());
  WarnOfRows(*rows, layout, recording.warnings);
  const TimingClues clues = CluesOf(*rows, layout, recording.warnings);
  const auto timing = ResolveTiming(clues, rows->count, layout.labels.size(), options, source_name,
                                    recording.warnings);
  if (!timing) return tl::unexpected(timing.error());
  NamedMarkers named = NameMarkers(layout.labels, recording.warnings);
  recording.subject = named.subject;
  recording.tracks = StageTracks(std::move(named.names), timing->num_frames, timing->rate_hz,
                                 timing->first_frame, timing->start);
  PlaceSamples(*rows, *timing, unit->mm_per_unit, options.zero_is_missing, recording.tracks,
               recording.warnings);
  return recording;
}

void AppendSample(const StageTracks& tracks, int frame, int marker, char delimiter,
                  std::string& out) {
  constexpr double kLastDigit = 1e-4;
  if (tracks.is_missing(frame, marker)) {
    out.append(3, delimiter);
    return;
  }
  Eigen::Vector3d position = tracks.position_mm(frame, marker);
  if (position.cwiseAbs().maxCoeff() < kLastDigit / 2) position.x() = kLastDigit;
  for (const double coordinate : position) {
    out += delimiter;
    AppendFixed(coordinate, out);
  }
}

void AppendRows(const StageTracks& tracks, const RowStyle& style, std::string& out) {
  // Times are computed from the rate alone where they can be, not added to a rounded start.
  const SessionTime start = SnapStart(tracks.start(), tracks.first_frame(), tracks.rate_hz());
  const bool is_nominal = start == NominalStart(tracks.first_frame(), tracks.rate_hz());
  const int frames_before = is_nominal ? std::max(tracks.first_frame(), 1) - 1 : 0;
  const double origin_s = is_nominal ? 0 : SecondsOf(start);
  out.reserve(out.size() + static_cast<std::size_t>(tracks.num_frames()) *
                               (24 + 30 * static_cast<std::size_t>(tracks.num_markers())));
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    if (style.with_frame)
      fmt::format_to(std::back_inserter(out), "{}", tracks.first_frame() + frame);
    if (style.with_sub_frame) (out += style.delimiter) += '0';
    if (style.with_time) {
      if (style.with_frame) out += style.delimiter;
      AppendSeconds(origin_s + (double(frames_before) + frame) / tracks.rate_hz(), out);
    }
    for (int marker = 0; marker < tracks.num_markers(); ++marker)
      AppendSample(tracks, frame, marker, style.delimiter, out);
    out += '\n';
  }
}

}  // namespace articap
