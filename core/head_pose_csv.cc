// SPDX-License-Identifier: MIT
// The file form of a head pose, see WriteHeadPoseCsv in core/head_pose.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

#include "core/csv_rows.h"
#include "core/csv_values.h"
#include "core/head_pose.h"

namespace articap {
namespace {

constexpr std::array<std::string_view, 11> kColumns = {
    "frame", "time_s", "tx_mm", "ty_mm", "tz_mm", "qw", "qx", "qy", "qz", "residual_mm", "status"};
constexpr std::array kStatuses = {HeadPoseStatus::kOk, HeadPoseStatus::kTooFewReferences,
                                  HeadPoseStatus::kIllConditioned, HeadPoseStatus::kLargeResidual};
constexpr std::array kModes = {StabilizationMode::kRigid, StabilizationMode::kTranslation,
                               StabilizationMode::kNone};

std::optional<std::int64_t> ParseDigits(std::string_view text) {
  std::int64_t value = 0;
  const bool all_digits = std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!all_digits || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Session times are whole nanoseconds; nine decimals lose nothing.
std::string FormatTime(SessionTime time) {
  const std::int64_t ns = time.time_since_epoch().count();
  const std::uint64_t magnitude = ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : ns;
  return fmt::format("{}{}.{:09}", ns < 0 ? "-" : "", magnitude / 1000000000,
                     magnitude % 1000000000);
}

// The inverse of FormatTime, exact to the nanosecond; at most nine decimals. Times beyond 4e9 s are
// refused, so that no arithmetic on them overflows.
std::optional<SessionTime> ParseTime(std::string_view cell) {
  const bool is_negative = cell.starts_with('-');
  if (is_negative) cell.remove_prefix(1);
  const std::size_t point = std::min(cell.find('.'), cell.size());
  std::string decimals(cell.substr(std::min(point + 1, cell.size())));
  if (decimals.size() > 9) return std::nullopt;
  decimals.resize(9, '0');
  const auto seconds = ParseDigits(cell.substr(0, point));
  const auto nanoseconds = ParseDigits(decimals);
  if (!seconds || !nanoseconds || *seconds > 4000000000) return std::nullopt;
  const std::int64_t ns = *seconds * 1000000000 + *nanoseconds;
  return SessionTime(std::chrono::nanoseconds(is_negative ? -ns : ns));
}

struct Preamble {
  StabilizationMode mode = StabilizationMode::kRigid;
  double rate_hz = 1;
};

// "# mode: rigid, rate_hz: 60"
Result<Preamble> ParsePreamble(std::string_view line, const std::string& source_name) {
  const auto fail = [&] {
    return Fail(
        fmt::format("{}: not a head pose: its first line must be like "
                    "\"# mode: rigid, rate_hz: 60\"",
                    source_name));
  };
  constexpr std::string_view kMode = "# mode: ", kRate = ", rate_hz: ";
  if (line.ends_with('\r')) line.remove_suffix(1);
  const std::size_t rate_at = line.find(kRate);
  if (!line.starts_with(kMode) || rate_at == std::string_view::npos) return fail();
  const std::string_view mode_name = line.substr(kMode.size(), rate_at - kMode.size());
  const auto mode = std::ranges::find_if(
      kModes, [&](StabilizationMode candidate) { return NameOf(candidate) == mode_name; });
  const auto rate_hz = ParseFinite(line.substr(rate_at + kRate.size()));
  if (mode == kModes.end() || !rate_hz || *rate_hz < 1e-3 || *rate_hz > 1e6) return fail();
  return Preamble{*mode, *rate_hz};
}

Result<HeadPose> ParsePose(const std::vector<std::string_view>& cells, const std::string& where) {
  HeadPose pose;
  const auto status = std::ranges::find_if(
      kStatuses, [&](HeadPoseStatus candidate) { return NameOf(candidate) == cells.back(); });
  if (status == kStatuses.end())
    return Fail(
        fmt::format("{}: unknown status '{}'; one of ok, too_few_references, "
                    "ill_conditioned, large_residual",
                    where, cells.back()));
  pose.status = *status;
  pose.residual_mm = std::numeric_limits<double>::quiet_NaN();
  if (!pose.is_known()) {
    for (int i = 2; i < 10; ++i)
      if (!cells[i].empty())
        return Fail(fmt::format("{}: {} has a value although the status is {}", where, kColumns[i],
                                cells.back()));
    return pose;
  }
  std::array<double, 8> values{};
  if (cells[9].empty()) values[7] = pose.residual_mm;
  for (int i = 2; i < (cells[9].empty() ? 9 : 10); ++i) {
    const auto value = ParseFinite(cells[i]);
    if (!value)
      return Fail(fmt::format("{}: {} is '{}', not a number", where, kColumns[i], cells[i]));
    values[i - 2] = *value;
  }
  pose.head_from_stage.translation_mm = {values[0], values[1], values[2]};
  pose.head_from_stage.rotation = Eigen::Quaterniond(values[3], values[4], values[5], values[6]);
  if (std::abs(pose.head_from_stage.rotation.norm() - 1) > 1e-6)
    return Fail(fmt::format("{}: qw,qx,qy,qz is no unit quaternion: its norm is {}", where,
                            pose.head_from_stage.rotation.norm()));
  pose.residual_mm = values[7];
  return pose;
}

// Frame numbers and times must run on at the stated rate: a row lost in the middle is an error.
Result<void> CheckFrameAndTime(const std::vector<std::string_view>& cells, const std::string& where,
                               HeadPoseTrack& track) {
  const auto frame = ParseInteger(cells[0]);
  const auto time = ParseTime(cells[1]);
  if (!frame || *frame < 0 || !time)
    return Fail(fmt::format("{}: '{}' is no frame number or '{}' no time in seconds", where,
                            cells[0], cells[1]));
  if (track.poses.empty()) {
    track.first_frame = *frame;
    track.start = *time;
    return {};
  }
  const auto row = static_cast<std::int64_t>(track.poses.size());
  if (*frame != track.first_frame + row)
    return Fail(
        fmt::format("{}: frame {} follows frame {}", where, *frame, track.first_frame + row - 1));
  const double elapsed_s = SecondsOf(SessionTime(*time - track.start));
  const double expected_s = static_cast<double>(row) / track.rate_hz;
  if (std::abs(elapsed_s - expected_s) > 0.5 / track.rate_hz)
    return Fail(fmt::format("{}: time {} s, but {} frames/s put this frame {} s after the first",
                            where, cells[1], track.rate_hz, expected_s));
  return {};
}

std::string FiniteOrEmpty(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}

}  // namespace

std::string WriteHeadPoseCsv(const HeadPoseTrack& track) {
  std::string text = fmt::format("# mode: {}, rate_hz: {}\n{}\n", NameOf(track.mode), track.rate_hz,
                                 "frame,time_s,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz,residual_mm,status");
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    const HeadPose& pose = track.poses[i];
    const auto row = static_cast<std::int64_t>(i);
    fmt::format_to(out, "{},{},", track.first_frame + row,
                   FormatTime(TimeOfFrame(row, track.rate_hz, track.start)));
    if (pose.is_known()) {
      const Eigen::Vector3d& t = pose.head_from_stage.translation_mm;
      const Eigen::Quaterniond& q = pose.head_from_stage.rotation;
      fmt::format_to(out, "{},{},{},{},{},{},{},{},{}\n", t.x(), t.y(), t.z(), q.w(), q.x(), q.y(),
                     q.z(), FiniteOrEmpty(pose.residual_mm), NameOf(pose.status));
    } else {
      fmt::format_to(out, ",,,,,,,,{}\n", NameOf(pose.status));
    }
  }
  return text;
}

Result<HeadPoseTrack> ParseHeadPoseCsv(const std::string& text, const std::string& source_name) {
  const std::size_t end_of_line = std::min(text.find('\n'), text.size());
  const auto preamble = ParsePreamble(std::string_view(text).substr(0, end_of_line), source_name);
  if (!preamble) return tl::unexpected(preamble.error());
  HeadPoseTrack track;
  track.mode = preamble->mode;
  track.rate_hz = preamble->rate_hz;

  CsvRows rows(text, source_name);
  std::vector<std::string_view> cells;
  for (int line = 0;; ++line) {
    const auto has_row = rows.Next(cells);
    if (!has_row) return tl::unexpected(has_row.error());
    if (line == 0) continue;  // the preamble
    if (line == 1) {
      if (!*has_row || !std::ranges::equal(cells, kColumns))
        return Fail(
            fmt::format("{}: the second line must name the columns frame,time_s,tx_mm,"
                        "ty_mm,tz_mm,qw,qx,qy,qz,residual_mm,status",
                        source_name));
      continue;
    }
    if (!*has_row) break;
    if (cells.size() != kColumns.size())
      return Fail(
          fmt::format("{}: {} cells instead of {}", rows.Where(), cells.size(), kColumns.size()));
    if (const auto in_order = CheckFrameAndTime(cells, rows.Where(), track); !in_order)
      return tl::unexpected(in_order.error());
    auto pose = ParsePose(cells, rows.Where());
    if (!pose) return tl::unexpected(pose.error());
    track.poses.push_back(*pose);
  }
  return track;
}

}  // namespace articap
