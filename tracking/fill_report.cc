// SPDX-License-Identifier: MIT
#include "tracking/fill_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace articap {
namespace {

// Sums over gaps, of one marker or of all.
struct FillSums {
  int gaps = 0;
  int longest = 0;       // frames
  int missing = 0;       // samples
  int regressed = 0;     // samples
  int interpolated = 0;  // samples
  double sum_mm2 = 0;
  int estimated = 0;  // filled samples whose error is known

  void Add(const Gap& gap) {
    ++gaps;
    longest = std::max(longest, gap.length);
    missing += gap.length;
  }
  void Add(const FilledGap& fill) {
    (fill.is_regression ? regressed : interpolated) += fill.gap.length;
    if (fill.sigmas_mm.hasNaN()) return;
    sum_mm2 += fill.sigmas_mm.squaredNorm();
    estimated += fill.gap.length;
  }
  int num_filled() const { return regressed + interpolated; }
  double rms_mm() const {
    return estimated > 0 ? std::sqrt(sum_mm2 / estimated)
                         : std::numeric_limits<double>::quiet_NaN();
  }
};

std::string VerdictOf(const FillSums& all) {
  if (all.gaps == 0) return "the take has no gaps";
  const int left = all.missing - all.num_filled();
  return fmt::format("{} of {} missing samples are filled{}", all.num_filled(), all.missing,
                     left > 0 ? fmt::format("; {} are left", left) : "");
}

ReportTable::Row RowOf(const std::string& name, const FillSums& sums) {
  const auto number = [](int count) { return static_cast<double>(count); };
  return {name,
          {number(sums.gaps), number(sums.longest), number(sums.missing), number(sums.regressed),
           number(sums.interpolated), number(sums.missing - sums.num_filled()), sums.rms_mm()}};
}

}  // namespace

StageReport ReportFills(const StageTracks& tracks, const std::vector<Gap>& gaps,
                        const std::vector<FilledGap>& filled, const FillOptions& options) {
  std::vector<FillSums> sums(tracks.num_markers());
  FillSums all;
  for (const Gap& gap : gaps) {
    sums[gap.marker].Add(gap);
    all.Add(gap);
  }
  for (const FilledGap& fill : filled) {
    sums[fill.gap.marker].Add(fill);
    all.Add(fill);
  }
  StageReport report{.stage = "fill", .options = EchoOptions(options)};
  report.verdict = VerdictOf(all);
  report.figures = {{"gaps", all.gaps},
                    {"gaps_filled", static_cast<double>(filled.size())},
                    {"missing_samples", all.missing},
                    {"filled_samples", all.num_filled()},
                    {"longest_gap_frames", all.longest},
                    {"estimated_error_mm", all.rms_mm()}};
  ReportTable table{"gaps",
                    {"gaps", "longest_frames", "missing_samples", "by_regression",
                     "by_interpolation", "left", "estimated_error_mm"},
                    {}};
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    if (tracks.CountMissing(marker) == tracks.num_frames() && tracks.num_frames() > 0)
      report.warnings.push_back(
          fmt::format("the marker '{}' is never seen and stays missing", tracks.names()[marker]));
    if (sums[marker].gaps > 0) table.rows.push_back(RowOf(tracks.names()[marker], sums[marker]));
  }
  report.tables.push_back(std::move(table));
  if (const int unknown = all.num_filled() - all.estimated; unknown > 0)
    report.warnings.push_back(
        fmt::format("the errors of {} filled samples are not known: too little of the take is "
                    "without gaps to learn from",
                    unknown));
  return report;
}

}  // namespace articap
