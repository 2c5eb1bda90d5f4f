// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/report.h"
#include "tracking/doubt.h"
#include "tracking/take_review.h"

namespace articap {

// What is known of a labelled take as UTF-8 JSON: the stages' reports under their names, as
// ReportsToJson() has them, then "review", from which report/tracking_page.h makes its page.
//   rate_hz, first_frame, frames, views, frames_per_bin (long takes are summed up in bins),
//   markers: [{name, measured_percent, one_view_percent, filled_percent, gap_percent,
//     seen_percent_by_view, gaps, longest_gap_s, filled, residual_rms_px, residual_rms_mm,
//     jitter_at_rest_mm, median_margin, lowest_margin, lowest_margin_frame,
//     runs: [[origin, frames], ...] from the first frame on, as SampleOrigin numbers them,
//     largest_residuals_px, lowest_margins, by bin}],
//   sub_pixel: [{view, dots, x, y: {counts, peak_to_mean, chi_square}}],
//   doubts: [{frame, first, last, marker, other, kind, score, why}], the greatest first
// Frames are those of the recording; null stands for what is not known. The same take gives the
// same bytes.
std::string ReviewJson(const TakeReview& review, const std::vector<Doubt>& doubts,
                       const std::vector<StageReport>& reports);

}  // namespace articap
