// SPDX-License-Identifier: MIT
#include "core/io/timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "core/io/text.h"
#include "core/statistics.h"

namespace articap {
namespace {

// A rate in a file may be rounded to a few digits ("59.94" for 60000/1001): two parts in a million.
constexpr double kRateRounding = 2e-6;

// Times of rows that lie at whole frames of `rate_hz`, as far as their digits tell.
bool TimesAgree(const TimingClues& clues, const std::vector<double>& steps, double rate_hz) {
  const double resolution_s = 1.1 * std::pow(10.0, -clues.time_decimals);
  const std::vector<double>& times_s = clues.times_s;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double elapsed_s = steps[i] / rate_hz;
    const double tolerance_s = resolution_s + kRateRounding * std::abs(elapsed_s);
    if (!(std::abs(times_s[i] - times_s[0] - elapsed_s) <= tolerance_s)) return false;
  }
  return true;
}

// Its index, from 1; the size where all increase.
std::size_t FirstThatDoesNotIncrease(const std::vector<double>& values) {
  std::size_t i = 1;
  while (i < values.size() && std::isfinite(values[i - 1]) && values[i] > values[i - 1]) ++i;
  return i;
}

bool IsIncreasing(const std::vector<double>& values) {
  return values.empty() ||
         (FirstThatDoesNotIncrease(values) == values.size() && std::isfinite(values.back()));
}

// Frames since the first row, by the rows' distances in time: each a whole number of median steps.
std::vector<double> StepsOfTimes(const std::vector<double>& times_s) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < times_s.size(); ++i)
    differences.push_back(times_s[i] - times_s[i - 1]);
  const double step_s = MedianOf(differences);
  std::vector<double> steps(times_s.size(), 0.0);
  for (std::size_t i = 1; i < times_s.size(); ++i)
    steps[i] = steps[i - 1] + std::max(1.0, std::round(differences[i - 1] / step_s));
  return steps;
}

// Frames since the first row, by the frame numbers, or row by row without them.
std::vector<double> StepsOfNumbers(const TimingClues& clues, std::size_t num_rows,
                                   std::vector<std::string>& warnings) {
  std::vector<double> steps(num_rows);
  for (std::size_t i = 0; i < num_rows; ++i) steps[i] = static_cast<double>(i);
  if (clues.frame_numbers.empty()) return steps;
  if (!IsIncreasing(clues.frame_numbers)) {
    warnings.push_back("The frame numbers do not increase; the rows were counted instead.");
    return steps;
  }
  for (std::size_t i = 0; i < num_rows; ++i)
    steps[i] = std::round(clues.frame_numbers[i] - clues.frame_numbers[0]);
  return steps;
}

void WarnOfJitter(const TimingClues& clues, const std::vector<double>& steps, double rate_hz,
                  std::vector<std::string>& warnings) {
  double worst_s = 0;
  for (std::size_t i = 0; i < clues.times_s.size(); ++i)
    worst_s = std::max(worst_s, std::abs(clues.times_s[i] - clues.times_s[0] - steps[i] / rate_hz));
  if (worst_s > 2 * std::pow(10.0, -clues.time_decimals) + 1e-9 && worst_s * rate_hz > 0.01)
    warnings.push_back(fmt::format(
        "The time column departs by up to {:.3g} ms from the constant rate that was assumed.",
        1000 * worst_s));
}

// The rate with the fewest digits that explains the printed times of all rows to their last digit:
// 60, not 60.0000012. Nothing where no constant rate does. `frames_before_first` counts from time
// 0; without it, time counts from the first row's, which is then taken as exact.
std::optional<double> SimplestRate(const TimingClues& clues, const std::vector<double>& steps,
                                   std::optional<double> frames_before_first) {
  const double half_digit_s = 0.5 * std::pow(10.0, -clues.time_decimals) + 1e-12;
  const double origin_s = frames_before_first ? 0 : clues.times_s[0];
  double slowest_hz = 0;
  double fastest_hz = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double frames = steps[i] + frames_before_first.value_or(0);
    const double elapsed_s = clues.times_s[i] - origin_s;
    if (frames == 0 && std::abs(elapsed_s) <= half_digit_s) continue;
    if (elapsed_s + half_digit_s <= 0) return std::nullopt;
    slowest_hz = std::max(slowest_hz, frames / (elapsed_s + half_digit_s));
    if (elapsed_s > half_digit_s)
      fastest_hz = std::min(fastest_hz, frames / (elapsed_s - half_digit_s));
  }
  if (slowest_hz > fastest_hz || !IsUsableRate(0.5 * (slowest_hz + fastest_hz)))
    return std::nullopt;
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", 0.5 * (slowest_hz + fastest_hz), digits);
    const double rate_hz = ParseNumber(text).value_or(0);
    if (rate_hz >= slowest_hz && rate_hz <= fastest_hz) return rate_hz;
  }
  return std::nullopt;
}

// The rate that the time column tells. `steps` become whole frames since the first row.
double RateOfTimes(const TimingClues& clues, std::vector<double>& steps,
                   std::vector<std::string>& warnings) {
  steps = StepsOfTimes(clues.times_s);
  std::optional<double> frames_before;
  if (!clues.frame_numbers.empty()) frames_before = std::max(clues.frame_numbers[0], 1.0) - 1;
  if (frames_before)
    if (const auto rate_hz = SimplestRate(clues, steps, frames_before)) return *rate_hz;
  if (const auto rate_hz = SimplestRate(clues, steps, std::nullopt)) return *rate_hz;
  // Seven digits are more than times that jitter tell, and are the same when they are read again.
  const double mean_hz = steps.back() / (clues.times_s.back() - clues.times_s.front());
  const double rate_hz = ParseNumber(fmt::format("{:.7g}", mean_hz)).value_or(mean_hz);
  WarnOfJitter(clues, steps, rate_hz, warnings);
  return rate_hz;
}

Result<double> FollowTimes(const TimingClues& clues, const std::string& source_name,
                           std::vector<double>& steps, std::vector<std::string>& warnings) {
  const double rate_hz = RateOfTimes(clues, steps, warnings);
  if (clues.rate_hz && IsUsableRate(*clues.rate_hz) && TimesAgree(clues, steps, *clues.rate_hz))
    return *clues.rate_hz;  // and the frame numbers are wrong
  if (!IsUsableRate(rate_hz))
    return Fail(fmt::format(
        "{}: the time column gives a rate of {:g} frames a second; times must be in seconds",
        source_name, rate_hz));
  if (clues.rate_hz)
    warnings.push_back(fmt::format(
        "The header says {} frames a second, the time column {:.6g}; the time column was followed.",
        *clues.rate_hz, rate_hz));
  return rate_hz;
}

// The rate, and the frames since the first row, which may change when the times say so.
Result<double> ResolveRate(const TimingClues& clues, const MarkerReadOptions& options,
                           const std::string& source_name, std::vector<double>& steps,
                           std::vector<std::string>& warnings) {
  const bool has_header_rate = clues.rate_hz && IsUsableRate(*clues.rate_hz);
  if (clues.times_s.size() >= 2 && !(has_header_rate && TimesAgree(clues, steps, *clues.rate_hz))) {
    if (IsIncreasing(clues.times_s)) return FollowTimes(clues, source_name, steps, warnings);
    warnings.push_back("The times do not increase; the time column was ignored.");
  }
  if (has_header_rate) return *clues.rate_hz;
  if (options.rate_hz && IsUsableRate(*options.rate_hz)) {
    if (clues.rate_hz)
      warnings.push_back(fmt::format("The header's rate ({}) was replaced by the option's ({}).",
                                     *clues.rate_hz, *options.rate_hz));
    return *options.rate_hz;
  }
  if (clues.rate_hz)
    return Fail(
        fmt::format("{}: the header says {} frames a second and there is no time column to "
                    "tell better; give the rate with --rate-hz 100",
                    source_name, *clues.rate_hz));
  if (steps.size() < 2) {
    warnings.push_back("A single frame tells no rate; 1 Hz was assumed.");
    return 1;
  }
  if (clues.times_s.size() >= 2) {
    const std::size_t row = FirstThatDoesNotIncrease(clues.times_s);
    return Fail(
        fmt::format("{}: the times do not increase: {} s in row {} of the data, then {} s; "
                    "sort the rows and leave out those that come twice",
                    source_name, clues.times_s[row - 1], row, clues.times_s[row]));
  }
  return Fail(
      fmt::format("{}: the file holds neither a rate nor times; give the rate with --rate-hz 100",
                  source_name));
}

// Frames left out of the file become missing samples, unless there would be absurdly many.
Result<void> PlaceRows(const std::vector<double>& steps, std::size_t num_markers,
                       const std::string& source_name, Timing& timing,
                       std::vector<std::string>& warnings) {
  if (steps.empty()) return {};
  const double num_frames = steps.back() + 1;
  constexpr double kFewSamples = 5e5;
  if (num_frames > 10 * static_cast<double>(steps.size()) &&
      num_frames * static_cast<double>(std::max<std::size_t>(num_markers, 1)) > kFewSamples) {
    std::size_t worst = 1;
    for (std::size_t i = 1; i < steps.size(); ++i)
      if (steps[i] - steps[i - 1] > steps[worst] - steps[worst - 1]) worst = i;
    return Fail(
        fmt::format("{}: the frames jump by {:.0f} between rows {} and {} of the data; the "
                    "file is damaged there",
                    source_name, steps[worst] - steps[worst - 1], worst, worst + 1));
  }
  timing.num_frames = static_cast<int>(num_frames);
  for (const double step : steps) timing.frame_of_row.push_back(static_cast<int>(step));
  const int left_out = timing.num_frames - static_cast<int>(steps.size());
  if (left_out > 0)
    warnings.push_back(
        fmt::format("The file leaves out {} of {} frames; their samples are missing.", left_out,
                    timing.num_frames));
  return {};
}

}  // namespace

bool IsUsableRate(double rate_hz) {
  return std::isfinite(rate_hz) && rate_hz >= 0.01 && rate_hz <= 1e6;
}

bool IsUsableEventTime(double time_s) { return std::abs(time_s) <= 1e9; }

std::vector<MarkerEvent> UsableEvents(const std::vector<MarkerEvent>& events) {
  std::vector<MarkerEvent> usable;
  std::copy_if(events.begin(), events.end(), std::back_inserter(usable),
               [](const MarkerEvent& event) { return IsUsableEventTime(event.time_s); });
  return usable;
}

SessionTime NominalStart(int first_frame, double rate_hz) {
  constexpr double kLongest_s = 1e9;  // nanoseconds since then would not fit 64 bits by far
  const int frames_before = std::max(first_frame, 1) - 1;
  return frames_before / rate_hz < kLongest_s ? TimeOfFrame(frames_before, rate_hz) : SessionTime();
}

SessionTime SnapStart(SessionTime start, int first_frame, double rate_hz) {
  using std::chrono::microseconds;
  const SessionTime nominal = NominalStart(first_frame, rate_hz);
  const SessionTime rounded(std::chrono::round<microseconds>(start.time_since_epoch()));
  return std::chrono::abs(rounded - nominal) < microseconds(1) ? nominal : rounded;
}

Result<Timing> ResolveTiming(const TimingClues& clues, std::size_t num_rows,
                             std::size_t num_markers, const MarkerReadOptions& options,
                             const std::string& source_name, std::vector<std::string>& warnings) {
  Timing timing;
  std::vector<double> steps = StepsOfNumbers(clues, num_rows, warnings);
  const auto rate_hz = ResolveRate(clues, options, source_name, steps, warnings);
  if (!rate_hz) return tl::unexpected(rate_hz.error());
  if (options.rate_hz && std::abs(*options.rate_hz - *rate_hz) > 1e-5 * *rate_hz)
    return Fail(fmt::format(
        "{}: the file says {:.6g} frames a second, the option says {}; leave --rate-hz out",
        source_name, *rate_hz, *options.rate_hz));
  timing.rate_hz = *rate_hz;
  if (!clues.frame_numbers.empty() && std::abs(clues.frame_numbers[0]) < 1e9)
    timing.first_frame = static_cast<int>(std::lround(clues.frame_numbers[0]));
  constexpr double kLongestTime_s = 9e9;  // of 64 bits of nanoseconds; times since 1970 fit
  timing.start = NominalStart(timing.first_frame, timing.rate_hz);
  if (!clues.times_s.empty() && std::abs(clues.times_s[0]) < kLongestTime_s)
    timing.start =
        SnapStart(SessionTimeFromSeconds(clues.times_s[0]), timing.first_frame, timing.rate_hz);
  else if (!clues.times_s.empty())
    warnings.push_back(
        fmt::format("The first time, {} s, is beyond what can be kept; {} s was taken.",
                    clues.times_s[0], SecondsOf(timing.start)));
  if (const auto placed = PlaceRows(steps, num_markers, source_name, timing, warnings); !placed)
    return tl::unexpected(placed.error());
  return timing;
}

}  // namespace articap
