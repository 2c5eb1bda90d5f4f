// SPDX-License-Identifier: MIT
#include "tracking/review_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/json_text.h"

namespace articap {
namespace {

// Numbers that are not finite are kept here as they are; nlohmann writes them as null.
using Json = nlohmann::ordered_json;

// Drawn on a screen, more could not be told apart.
constexpr int kMostBins = 2000;

// Four digits say all there is to say.
double Rounded(double value) {
  if (!std::isfinite(value) || value == 0) return value;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3);
  return step < 1 ? std::round(value / step) / std::round(1 / step)
                  : std::round(value / step) * step;
}

Json RunsJson(const std::vector<SampleOrigin>& origins) {
  Json runs = Json::array();
  for (std::size_t first = 0; first < origins.size();) {
    std::size_t end = first;
    while (end < origins.size() && origins[end] == origins[first]) ++end;
    runs.push_back({static_cast<int>(origins[first]), end - first});
    first = end;
  }
  return runs;
}

// The worst of every bin: the one that `is_worse` than all others.
template <class Worse>
Json WorstOfBins(const std::vector<float>& values, int frames_per_bin, const Worse& is_worse) {
  Json worst = Json::array();
  for (std::size_t first = 0; first < values.size();
       first += static_cast<std::size_t>(frames_per_bin)) {
    const std::size_t end =
        std::min(values.size(), first + static_cast<std::size_t>(frames_per_bin));
    float chosen = std::nanf("");
    for (std::size_t i = first; i < end; ++i)
      if (std::isnan(chosen) || is_worse(values[i], chosen)) chosen = values[i];
    worst.push_back(Rounded(chosen));
  }
  return worst;
}

Json MarkerJson(const MarkerReview& marker, const TakeReview& take, int frames_per_bin) {
  Json by_view = Json::array();
  for (const double share : marker.seen_by_view) by_view.push_back(Rounded(100 * share));
  const bool has_margin = marker.lowest_margin_frame >= 0;
  return {{"name", marker.name},
          {"measured_percent", Rounded(100 * marker.ShareOf(SampleOrigin::kMeasured))},
          {"one_view_percent", Rounded(100 * marker.ShareOf(SampleOrigin::kOneView))},
          {"filled_percent", Rounded(100 * marker.ShareOf(SampleOrigin::kFilled))},
          {"gap_percent", Rounded(100 * marker.ShareOf(SampleOrigin::kGap))},
          {"seen_percent_by_view", std::move(by_view)},
          {"gaps", marker.gaps},
          {"longest_gap_s", Rounded(marker.longest_gap / take.rate_hz)},
          {"filled", marker.filled},
          {"residual_rms_px", Rounded(marker.residual_rms_px)},
          {"residual_rms_mm", Rounded(marker.residual_rms_mm)},
          {"jitter_at_rest_mm", Rounded(marker.jitter_at_rest_mm)},
          {"median_margin", Rounded(marker.median_margin)},
          {"lowest_margin", Rounded(marker.lowest_margin)},
          {"lowest_margin_frame",
           has_margin ? Json(take.first_frame + marker.lowest_margin_frame) : Json(nullptr)},
          {"runs", RunsJson(marker.origins)},
          {"largest_residuals_px", WorstOfBins(marker.residuals_px, frames_per_bin,
                                               [](float a, float b) { return a > b; })},
          {"lowest_margins",
           WorstOfBins(marker.margins, frames_per_bin, [](float a, float b) { return a < b; })}};
}

Json AxisJson(const SubPixelHistogram::Axis& axis) {
  return {{"counts", axis.counts},
          {"peak_to_mean", Rounded(axis.PeakToMean())},
          {"chi_square", Rounded(axis.ChiSquare())}};
}

const char* NameOf(DoubtKind kind) {
  switch (kind) {
    case DoubtKind::kSwap:
      return "swap";
    case DoubtKind::kMargin:
      return "margin";
    case DoubtKind::kResidual:
      return "residual";
    case DoubtKind::kFill:
      return "fill";
  }
  return "";
}

Json DoubtJson(const Doubt& doubt, const TakeReview& take) {
  return {{"frame", take.first_frame + doubt.frame},
          {"first", take.first_frame + doubt.first},
          {"last", take.first_frame + doubt.last},
          {"marker", take.markers[doubt.marker].name},
          {"other", doubt.other < 0 ? Json(nullptr) : Json(take.markers[doubt.other].name)},
          {"kind", NameOf(doubt.kind)},
          {"score", Rounded(doubt.score)},
          {"why", doubt.why}};
}

}  // namespace

std::string ReviewJson(const TakeReview& review, const std::vector<Doubt>& doubts,
                       const std::vector<StageReport>& reports) {
  const int frames_per_bin = std::max(1, (review.num_frames + kMostBins - 1) / kMostBins);
  Json json = {{"rate_hz", review.rate_hz},        {"first_frame", review.first_frame},
               {"frames", review.num_frames},      {"views", review.views},
               {"frames_per_bin", frames_per_bin}, {"markers", Json::array()},
               {"sub_pixel", Json::array()},       {"doubts", Json::array()}};
  for (const MarkerReview& marker : review.markers)
    json["markers"].push_back(MarkerJson(marker, review, frames_per_bin));
  for (std::size_t view = 0; view < review.sub_pixel.size(); ++view) {
    const SubPixelHistogram& histogram = review.sub_pixel[view];
    json["sub_pixel"].push_back({{"view", review.views[view]},
                                 {"dots", histogram.num_dots},
                                 {"x", AxisJson(histogram.x)},
                                 {"y", AxisJson(histogram.y)}});
  }
  for (const Doubt& doubt : doubts) json["doubts"].push_back(DoubtJson(doubt, review));
  Json all = Json::parse(ReportsToJson(reports));
  all["review"] = std::move(json);
  // What is known of a marker or a doubt has a line each, and so have the rows of tables.
  constexpr int kDeepestIndented = 3;
  return IndentedJson(all, kDeepestIndented);
}

}  // namespace articap
