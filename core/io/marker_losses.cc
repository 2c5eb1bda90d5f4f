// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/c3d_layout.h"
#include "core/io/formats.h"
#include "core/io/marker_names.h"
#include "core/io/timing.h"
#include "core/marker_io.h"

namespace articap {
namespace {

bool KeepsTimes(MarkerFormat format) {
  return format != MarkerFormat::kC3d && format != MarkerFormat::kNexusCsv;
}

struct SampleSummary {
  bool has_filled = false;
  bool has_sigma = false;
  double largest_rounding_mm = 0;
  int beyond_float = 0;
};

// How far the nearest float, or the nearest 0.0001 mm, is from the coordinate.
double RoundingMm(double coordinate_mm, bool to_float) {
  if (to_float)
    return std::abs(static_cast<double>(static_cast<float>(coordinate_mm)) - coordinate_mm);
  constexpr double kExactIntegers = 4503599627370496.0;   // 2^52
  constexpr double kRoundToInteger = 6755399441055744.0;  // adding 1.5 * 2^52 drops the fraction
  const double steps = coordinate_mm * 1e4;
  if (std::abs(steps) > kExactIntegers / 4) return 0;
  return std::abs((steps + kRoundToInteger) - kRoundToInteger - steps) * 1e-4;
}

SampleSummary Summarize(const StageTracks& tracks, bool to_float) {
  SampleSummary summary;
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      if (tracks.is_missing(frame, marker)) continue;
      summary.has_filled |= tracks.state(frame, marker) == SampleState::kFilled;
      summary.has_sigma |= !std::isnan(tracks.sigma_mm(frame, marker));
      for (const double coordinate : tracks.position_mm(frame, marker)) {
        const double rounding = RoundingMm(coordinate, to_float);
        if (std::isfinite(rounding))
          summary.largest_rounding_mm = std::max(summary.largest_rounding_mm, rounding);
        else
          ++summary.beyond_float;
      }
    }
  return summary;
}

void AddSampleLosses(const MarkerRecording& recording, MarkerFormat format,
                     std::vector<std::string>& losses) {
  const bool is_c3d = format == MarkerFormat::kC3d;
  const SampleSummary summary = Summarize(recording.tracks, is_c3d);
  constexpr double kNegligible_mm = 1e-5;
  if (summary.largest_rounding_mm > kNegligible_mm)
    losses.push_back(fmt::format("Positions are rounded {}, by up to {:.2g} mm.",
                                 is_c3d ? "to 32-bit floats" : "to 0.0001 mm",
                                 summary.largest_rounding_mm));
  if (summary.beyond_float > 0)
    losses.push_back(fmt::format("{} coordinates are too large for a float; they become missing.",
                                 summary.beyond_float));
  if (summary.has_sigma) losses.push_back("The standard deviations of the samples are not kept.");
  if (summary.has_filled && !is_c3d)
    losses.push_back("Filled samples can no longer be told from measured ones.");
}

void AddC3dLosses(const MarkerRecording& recording, std::vector<std::string>& losses) {
  const StageTracks& tracks = recording.tracks;
  if (DecimalOf(static_cast<float>(tracks.rate_hz())) != tracks.rate_hz())
    losses.push_back(
        fmt::format("The rate of {} Hz is rounded to seven digits.", tracks.rate_hz()));
  if (tracks.num_markers() == 0 && recording.analog.channels.empty() && tracks.num_frames() > 0)
    losses.push_back(
        fmt::format("{} frames without markers and channels are not kept.", tracks.num_frames()));
  if (tracks.first_frame() < 0)
    losses.push_back(fmt::format("The first frame's number ({}) becomes 0.", tracks.first_frame()));
  const bool has_wide_masks =
      std::any_of(recording.camera_masks.begin(), recording.camera_masks.end(),
                  [](std::uint8_t mask) { return mask > 0x7F; });
  if (has_wide_masks) losses.push_back("The eighth camera's bits are not kept.");
  const float step_mm = C3dResidualStep(recording);
  float rounding_mm = 0;
  for (const float residual : recording.residuals_mm)
    if (std::isfinite(residual))
      rounding_mm = std::max(
          rounding_mm,
          std::abs(std::clamp(std::round(residual / step_mm), 0.F, 255.F) * step_mm - residual));
  if (rounding_mm > 1e-6F)
    losses.push_back(fmt::format("The residuals are rounded to multiples of {:.4g} mm.", step_mm));
}

void AddTextLosses(const MarkerRecording& recording, MarkerFormat format,
                   std::vector<std::string>& losses) {
  if (!recording.residuals_mm.empty()) losses.push_back("The residuals are not kept.");
  if (!recording.camera_masks.empty()) losses.push_back("The camera masks are not kept.");
  if (!recording.descriptions.empty())
    losses.push_back("The descriptions of the markers are not kept.");
  if (!recording.analog.channels.empty())
    losses.push_back(
        fmt::format("{} analog channels are not kept.", recording.analog.channels.size()));
  if (recording.events.empty()) return;
  if (format != MarkerFormat::kQualisysTsv) {
    losses.push_back(fmt::format("{} events are not kept.", recording.events.size()));
    return;
  }
  const bool has_more =
      std::any_of(recording.events.begin(), recording.events.end(), [](const MarkerEvent& event) {
        return !event.context.empty() || !event.subject.empty() || !event.description.empty();
      });
  if (has_more)
    losses.push_back(
        "Of the events only labels and times are kept, no contexts, subjects and "
        "descriptions.");
}

void AddNameLosses(const MarkerRecording& recording, std::vector<std::string>& losses) {
  const std::vector<std::string> labels = LabelsToWrite(recording);
  const std::string prefix = recording.subject.empty() ? "" : recording.subject + ":";
  int changed = 0;
  std::string example;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::string& name = recording.tracks.names()[i];
    if (labels[i] == prefix + name) continue;
    if (changed++ == 0) example = fmt::format("\"{}\" becomes \"{}\"", name, labels[i]);
  }
  if (changed > 0) losses.push_back(fmt::format("{} marker names change: {}.", changed, example));
}

}  // namespace

std::vector<std::string> LossesOf(const MarkerRecording& recording, MarkerFormat format) {
  std::vector<std::string> losses;
  const StageTracks& tracks = recording.tracks;
  AddSampleLosses(recording, format, losses);
  if (format == MarkerFormat::kC3d)
    AddC3dLosses(recording, losses);
  else
    AddTextLosses(recording, format, losses);
  AddNameLosses(recording, losses);
  if (const auto lost = recording.events.size() - UsableEvents(recording.events).size())
    losses.push_back(fmt::format("{} events lie beyond all time and are not kept.", lost));
  const SessionTime kept_start =
      KeepsTimes(format) ? SnapStart(tracks.start(), tracks.first_frame(), tracks.rate_hz())
                         : NominalStart(tracks.first_frame(), tracks.rate_hz());
  if (kept_start != tracks.start())
    losses.push_back(fmt::format("The first frame's time changes from {:.9g} s to {:.9g} s.",
                                 SecondsOf(tracks.start()), SecondsOf(kept_start)));
  return losses;
}

}  // namespace articap
