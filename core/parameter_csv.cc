// SPDX-License-Identifier: MIT
// The CSV form of a ParameterTrack: what people open in a spreadsheet and read with pandas.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>

#include "core/check.h"
#include "core/csv_rows.h"
#include "core/io/timing.h"
#include "core/parameter_track.h"
#include "core/parameter_units.h"

namespace articap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr char kSigmaPrefix[] = "sigma_";

// Writing. Six decimals: a nanometre, a millionth of a degree, three orders below any sensor. Fixed
// decimals also make write(read(write(x))) the same bytes although degrees become radians between.
constexpr int kDecimals = 6;
constexpr double kTenToDecimals = 1e6;

void AppendDigits(std::string& text, std::uint64_t value, int min_digits) {
  char digits[20];
  char* const end = digits + sizeof digits;
  char* begin = end;
  while (value > 0 || end - begin < min_digits) {
    *--begin = static_cast<char>('0' + value % 10);
    value /= 10;
  }
  text.append(begin, end);
}

// Empty for NaN, "inf" for infinite sigmas.
void AppendNumber(std::string& text, double value) {
  constexpr double kLargestFixed = 1e12;
  if (std::isnan(value)) return;
  if (std::abs(value) >= kLargestFixed) {
    char buffer[40];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 12).ptr;
    text.append(buffer, end);
    return;
  }
  const std::int64_t scaled = std::llround(value * kTenToDecimals);
  if (scaled < 0) text += '-';
  const std::uint64_t magnitude = static_cast<std::uint64_t>(std::abs(scaled));
  constexpr auto kScale = static_cast<std::uint64_t>(kTenToDecimals);
  AppendDigits(text, magnitude / kScale, 1);
  text += '.';
  AppendDigits(text, magnitude % kScale, kDecimals);
}

// Seconds to the nanosecond, so that no time is lost.
void AppendTime(std::string& text, SessionTime time) {
  constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
  const std::int64_t count = time.time_since_epoch().count();
  if (count < 0) text += '-';
  const std::uint64_t magnitude = static_cast<std::uint64_t>(std::abs(count));
  AppendDigits(text, magnitude / kNanosecondsPerSecond, 1);
  text += '.';
  AppendDigits(text, magnitude % kNanosecondsPerSecond, 9);
}

std::string HeaderOf(const ParameterTrack& track) {
  std::string header = "frame,time_s";
  for (const char* prefix : {"", kSigmaPrefix})
    for (std::size_t i = 0; i < track.names.size(); ++i) {
      header += ',';
      header +=
          CsvCell(fmt::format("{}{}[{}]", prefix, track.names[i], FileUnitOf(track.units[i]).name));
    }
  header += ",residual_mm,status";
  if (!track.phones.empty()) header += ",phone";
  return header + "\n";
}

// Reading.

std::string Quoted(std::string_view cell) {
  constexpr std::size_t kLongest = 40;
  return cell.size() <= kLongest ? fmt::format("'{}'", cell)
                                 : fmt::format("'{}...'", cell.substr(0, kLongest));
}

template <class Number>
std::optional<Number> ParseWhole(std::string_view cell) {
  Number number{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return number;
}

// What the columns of a file mean.
struct Columns {
  std::vector<std::string> names;
  std::vector<std::string> units;         // of the track
  std::vector<double> value_per_in_file;  // a parameter each
  std::size_t num_sigmas = 0;             // as many as parameters, or none
  bool has_phones = false;

  std::size_t residual() const { return 2 + names.size() + num_sigmas; }
  std::size_t status() const { return residual() + 1; }
  std::size_t size() const { return status() + (has_phones ? 2 : 1); }
};

// "name[unit]" in two.
struct NameAndUnit {
  std::string_view name, unit;
};
std::optional<NameAndUnit> SplitUnit(std::string_view header) {
  const std::size_t bracket = header.rfind('[');
  if (bracket == std::string_view::npos || bracket == 0 || !header.ends_with(']'))
    return std::nullopt;
  return NameAndUnit{header.substr(0, bracket),
                     header.substr(bracket + 1, header.size() - bracket - 2)};
}

Result<void> AddParameter(std::string_view header, const std::string& where, Columns& columns) {
  const auto parts = SplitUnit(header);
  if (!parts)
    return Fail(fmt::format("{}: column {} names no unit; parameter columns read name[unit]", where,
                            Quoted(header)));
  const auto unit = TrackUnitOf(parts->unit);
  if (!unit)
    return Fail(fmt::format("{}: column {} has the unit {}, which is not known; use deg, mm or 1",
                            where, Quoted(header), Quoted(parts->unit)));
  if (std::find(columns.names.begin(), columns.names.end(), parts->name) != columns.names.end())
    return Fail(
        fmt::format("{}: the parameter {} is there twice; keep one", where, Quoted(parts->name)));
  columns.names.emplace_back(parts->name);
  columns.units.push_back(unit->name);
  columns.value_per_in_file.push_back(unit->value_per_in_file);
  return {};
}

// The header that `columns` would have from `first` on, where the sigmas begin.
bool AreSigmas(const std::vector<std::string_view>& header, std::size_t first,
               const std::vector<std::string_view>& parameter_headers) {
  if (header.size() < first + parameter_headers.size()) return false;
  for (std::size_t i = 0; i < parameter_headers.size(); ++i)
    if (header[first + i] != kSigmaPrefix + std::string(parameter_headers[i])) return false;
  return true;
}

Result<Columns> ParseHeader(const std::vector<std::string_view>& header, const std::string& where) {
  if (header.size() < 2 || header[0] != "frame" || header[1] != "time_s")
    return Fail(fmt::format(
        "{}: is not a table of parameters: its columns begin with {}, not with frame,time_s", where,
        Quoted(header.empty() ? "" : header[0])));
  const std::size_t residual = static_cast<std::size_t>(
      std::find(header.begin(), header.end(), "residual_mm") - header.begin());
  if (residual == header.size() || residual + 1 >= header.size() ||
      header[residual + 1] != "status")
    return Fail(
        fmt::format("{}: the columns residual_mm,status are missing after the parameters", where));
  Columns columns;
  columns.has_phones = residual + 2 < header.size();
  if (columns.has_phones && (header[residual + 2] != "phone" || residual + 3 != header.size()))
    return Fail(fmt::format("{}: column {} is not known; only phone may follow status", where,
                            Quoted(header[residual + 2])));

  const std::size_t num_between = residual - 2;
  const std::vector<std::string_view> first_half(
      header.begin() + 2, header.begin() + 2 + static_cast<std::ptrdiff_t>(num_between / 2));
  const bool has_sigmas =
      num_between > 0 && num_between % 2 == 0 && AreSigmas(header, 2 + num_between / 2, first_half);
  const std::size_t num_parameters = has_sigmas ? num_between / 2 : num_between;
  for (std::size_t i = 0; i < num_parameters; ++i)
    if (const auto added = AddParameter(header[2 + i], where, columns); !added)
      return tl::unexpected(added.error());
  columns.num_sigmas = has_sigmas ? num_parameters : 0;
  return columns;
}

// What the rows hold, as they are read.
struct Rows {
  int first_frame = 1;
  std::vector<int> lines;  // in the file
  std::vector<std::int64_t> times_ns;
  std::vector<double> values, sigmas;  // row by row
  std::vector<double> residuals_mm;
  std::vector<FitStatus> statuses;
  std::vector<std::string> phones;
};

Result<double> ParseValue(std::string_view cell, bool may_be_infinite, const CsvRows& csv) {
  if (cell.empty()) return kNaN;
  const auto value = ParseWhole<double>(cell);
  if (!value || std::isnan(*value) || (std::isinf(*value) && !may_be_infinite))
    return Fail(fmt::format("{}: {} is not a number; leave a cell empty where there is no value",
                            csv.Where(), Quoted(cell)));
  return *value;
}

Result<void> ParseFrameAndTime(const std::vector<std::string_view>& cells, const CsvRows& csv,
                               Rows& rows) {
  constexpr double kLongestSeconds = 4e9;  // so that differences fit in int64 nanoseconds
  const auto frame = ParseWhole<int>(cells[0]);
  if (!frame)
    return Fail(fmt::format("{}: frame {} is not a whole number", csv.Where(), Quoted(cells[0])));
  if (rows.lines.empty()) rows.first_frame = *frame;
  const std::int64_t expected =
      static_cast<std::int64_t>(rows.first_frame) + static_cast<std::int64_t>(rows.lines.size());
  if (*frame != expected)
    return Fail(fmt::format(
        "{}: frame {} follows frame {}; every frame needs its row (empty cells where there is no "
        "fit)",
        csv.Where(), *frame, expected - 1));
  const auto time_s = ParseWhole<double>(cells[1]);
  if (!time_s || !(std::abs(*time_s) < kLongestSeconds))
    return Fail(
        fmt::format("{}: time_s {} is not a time in seconds", csv.Where(), Quoted(cells[1])));
  rows.times_ns.push_back(std::llround(*time_s * 1e9));
  return {};
}

Result<void> ParseRow(const std::vector<std::string_view>& cells, const Columns& columns,
                      const CsvRows& csv, Rows& rows) {
  if (cells.size() != columns.size())
    return Fail(fmt::format("{}: {} cells, but the header names {} columns", csv.Where(),
                            cells.size(), columns.size()));
  if (const auto parsed = ParseFrameAndTime(cells, csv, rows); !parsed)
    return tl::unexpected(parsed.error());
  const std::size_t num_parameters = columns.names.size();
  for (std::size_t i = 0; i < num_parameters; ++i) {
    const auto value = ParseValue(cells[2 + i], false, csv);
    if (!value) return tl::unexpected(value.error());
    rows.values.push_back(columns.value_per_in_file[i] * *value);
  }
  for (std::size_t i = 0; i < columns.num_sigmas; ++i) {
    const auto sigma = ParseValue(cells[2 + num_parameters + i], true, csv);
    if (!sigma) return tl::unexpected(sigma.error());
    if (*sigma < 0) return Fail(fmt::format("{}: a sigma of {} is negative", csv.Where(), *sigma));
    rows.sigmas.push_back(columns.value_per_in_file[i] * *sigma);
  }
  const auto residual_mm = ParseValue(cells[columns.residual()], false, csv);
  if (!residual_mm) return tl::unexpected(residual_mm.error());
  rows.residuals_mm.push_back(*residual_mm);
  const auto status = FitStatusNamed(cells[columns.status()]);
  if (!status)
    return Fail(
        fmt::format("{}: status {} is not known", csv.Where(), Quoted(cells[columns.status()])));
  rows.statuses.push_back(*status);
  if (columns.has_phones) rows.phones.emplace_back(cells.back());
  rows.lines.push_back(csv.line());
  return {};
}

bool ExplainsTimes(double rate_hz, const std::vector<std::int64_t>& times_ns) {
  const SessionTime start{std::chrono::nanoseconds(times_ns.front())};
  for (std::size_t i = 1; i < times_ns.size(); ++i)
    if (TimeOfFrame(static_cast<std::int64_t>(i), rate_hz, start).time_since_epoch().count() !=
        times_ns[i])
      return false;
  return true;
}

// The roundest rate (fewest decimal digits) at which every time lies within the tolerance of the
// file's: 60 rather than 60.0000012. Nothing where no constant rate does.
std::optional<double> RoundestRate(const std::vector<std::int64_t>& times_ns, double tolerance_ns) {
  double shortest_ns = 0;
  double longest_ns = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    const double since_start_ns =
        static_cast<double>(times_ns[i]) - static_cast<double>(times_ns[0]);
    const double count = static_cast<double>(i);
    shortest_ns = std::max(shortest_ns, (since_start_ns - tolerance_ns) / count);
    longest_ns = std::min(longest_ns, (since_start_ns + tolerance_ns) / count);
  }
  if (!(shortest_ns > 0 && shortest_ns <= longest_ns)) return std::nullopt;
  const double lowest_hz = 1e9 / longest_ns;
  const double highest_hz = 1e9 / shortest_ns;
  const double middle_hz = (lowest_hz + highest_hz) / 2;
  const bool exact = tolerance_ns <= 0.5;
  for (int digits = 1; digits <= 17; ++digits) {
    const double rate_hz = std::strtod(fmt::format("{:.{}g}", middle_hz, digits).c_str(), nullptr);
    if (rate_hz < lowest_hz || rate_hz > highest_hz) continue;
    if (!exact || ExplainsTimes(rate_hz, times_ns)) return rate_hz;
  }
  return middle_hz;
}

// Times of other programs may be rounded: to microseconds, to tenths of a millisecond, ...
Result<double> RateOf(const Rows& rows, const std::string& source_name) {
  const std::vector<std::int64_t>& times_ns = rows.times_ns;
  if (times_ns.size() < 2) return 1.0;
  const double count = static_cast<double>(times_ns.size() - 1);
  const double period_ns =
      (static_cast<double>(times_ns.back()) - static_cast<double>(times_ns.front())) / count;
  for (const double tolerance_ns : {0.5, 5e2, 5e4, 5e5})
    if (tolerance_ns < std::max(1.0, 0.2 * period_ns))
      if (const auto rate_hz = RoundestRate(times_ns, tolerance_ns)) {
        if (IsUsableRate(*rate_hz)) return *rate_hz;
        return Fail(
            fmt::format("{}:{}: the times give {:.3g} frames a second; time_s must be in seconds",
                        source_name, rows.lines.back(), *rate_hz));
      }
  double largest_ns = -1;
  std::size_t worst = 0;
  for (std::size_t i = 1; i < times_ns.size(); ++i) {
    const double step_ns = static_cast<double>(times_ns[i]) - static_cast<double>(times_ns[i - 1]);
    if (std::abs(step_ns - period_ns) <= largest_ns) continue;
    largest_ns = std::abs(step_ns - period_ns);
    worst = i;
  }
  return Fail(fmt::format(
      "{}:{}: the times are not at a constant rate: this row comes {:.6g} s after the one before, "
      "where the mean step is {:.6g} s",
      source_name, rows.lines[worst],
      static_cast<double>(times_ns[worst] - times_ns[worst - 1]) * 1e-9, period_ns * 1e-9));
}

Eigen::MatrixXd MatrixOf(const std::vector<double>& rows, std::size_t num_rows,
                         std::size_t num_columns) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(rows.data(), static_cast<Eigen::Index>(num_rows),
                                    static_cast<Eigen::Index>(num_columns));
}

}  // namespace

std::string WriteParameterCsv(const ParameterTrack& track) {
  CheckSizes(track);
  std::string text = HeaderOf(track);
  const int num_parameters = track.num_parameters();
  std::vector<double> factors(num_parameters);
  for (int i = 0; i < num_parameters; ++i)
    factors[i] = FileUnitOf(track.units[i]).in_file_per_value;
  constexpr std::size_t kUsualCell = 11;
  text.reserve(text.size() + static_cast<std::size_t>(track.num_frames()) * kUsualCell *
                                 static_cast<std::size_t>(2 * num_parameters + 5));
  for (int frame = 0; frame < track.num_frames(); ++frame) {
    text += std::to_string(track.first_frame + frame);
    text += ',';
    AppendTime(text, TimeOfFrame(frame, track.rate_hz, track.start));
    for (const Eigen::MatrixXd* table : {&track.values, &track.sigmas})
      for (int i = 0; i < num_parameters; ++i) {
        text += ',';
        AppendNumber(text, factors[i] * (*table)(frame, i));
      }
    text += ',';
    AppendNumber(text, track.residuals_mm[frame]);
    text += ',';
    text += NameOf(track.statuses[frame]);
    if (!track.phones.empty()) {
      text += ',';
      text += CsvCell(track.phones[frame]);
    }
    text += '\n';
  }
  return text;
}

Result<ParameterTrack> ParseParameterCsv(const std::string& text, const std::string& source_name) {
  if (const std::size_t nul = text.find('\0'); nul != std::string::npos)
    return Fail(fmt::format("{}: is not text: byte {} is zero", source_name, nul));
  CsvRows csv(text, source_name);
  std::vector<std::string_view> cells;
  const auto has_header = csv.Next(cells);
  if (!has_header) return tl::unexpected(has_header.error());
  if (!*has_header) return Fail(fmt::format("{}: is empty", source_name));
  const auto columns = ParseHeader(cells, csv.Where());
  if (!columns) return tl::unexpected(columns.error());

  Rows rows;
  while (true) {
    const auto has_row = csv.Next(cells);
    if (!has_row) return tl::unexpected(has_row.error());
    if (!*has_row) break;
    if (const auto parsed = ParseRow(cells, *columns, csv, rows); !parsed)
      return tl::unexpected(parsed.error());
  }
  const auto rate_hz = RateOf(rows, source_name);
  if (!rate_hz) return tl::unexpected(rate_hz.error());

  ParameterTrack track;
  track.names = columns->names;
  track.units = columns->units;
  track.rate_hz = *rate_hz;
  track.first_frame = rows.first_frame;
  if (!rows.times_ns.empty())
    track.start = SessionTime(std::chrono::nanoseconds(rows.times_ns.front()));
  const std::size_t num_frames = rows.lines.size();
  if (columns->num_sigmas == 0) rows.sigmas.assign(rows.values.size(), kNaN);
  track.values = MatrixOf(rows.values, num_frames, track.names.size());
  track.sigmas = MatrixOf(rows.sigmas, num_frames, track.names.size());
  track.residuals_mm = std::move(rows.residuals_mm);
  track.statuses = std::move(rows.statuses);
  track.phones = std::move(rows.phones);
  return track;
}

}  // namespace articap
