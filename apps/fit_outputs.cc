// SPDX-License-Identifier: MIT
#include "apps/fit_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/animation.h"
#include "apps/residual_csv.h"
#include "report/report_page.h"

namespace articap {
namespace {

// Frames counted from 0 whose times lie in the window.
Result<FrameWindow> FramesOf(const TimeWindow& window, const ParameterTrack& track) {
  const double start_s = SecondsOf(track.start);
  // Clamped before they become integers: a window may reach as far as it likes.
  const auto frame_at = [&](double time_s) {
    return std::clamp((time_s - start_s) * track.rate_hz, -1.0,
                      static_cast<double>(track.num_frames()));
  };
  const int first = std::max(0, static_cast<int>(std::ceil(frame_at(window.start_s) - 1e-6)));
  const int last =
      std::min(track.num_frames() - 1, static_cast<int>(std::floor(frame_at(window.end_s) + 1e-6)));
  if (last < first)
    return Fail(fmt::format(
        "--window {}:{}: the take has no frame there, it lasts from {:.3f} to "
        "{:.3f} s",
        window.start_s, window.end_s, start_s, start_s + (track.num_frames() - 1) / track.rate_hz));
  return FrameWindow{first, last - first + 1};
}

std::string PageOf(const FitOutcome& outcome, const FaceRig& speaker,
                   const std::optional<FrameWindow>& window) {
  const ShapeFit& fit = outcome.fit;
  const MarkerResiduals residuals = {fit.measured.names(), fit.residuals_mm};
  ReportPageInput page;
  page.title = fmt::format("articap fit: {}", outcome.take_name);
  page.reports = outcome.reports;
  page.parameters = &fit.parameters;
  for (const RigParameter& parameter : speaker.definition().parameters)
    page.ranges.push_back({parameter.min, parameter.max, parameter.description});
  page.residuals = &residuals;
  page.head_pose = &outcome.head_pose;
  page.rig = &speaker;
  page.measured = &fit.measured;
  page.virtual_markers = &fit.virtual_markers;
  page.window = window;
  return BuildReportPage(page);
}

}  // namespace

Result<OutputSet> FitOutputs(FitOutcome& outcome, const FaceRig& rig,
                             const std::optional<TimeWindow>& window,
                             const std::filesystem::path& folder) {
  const ParameterTrack& track = outcome.fit.parameters;
  std::optional<FrameWindow> frames;
  if (window) {
    const Result<FrameWindow> chosen = FramesOf(*window, track);
    if (!chosen) return tl::unexpected(chosen.error());
    frames = *chosen;
  }
  const Result<FaceRig> speaker = RigOfBinding(outcome.binding, rig);
  if (!speaker) return tl::unexpected(speaker.error());
  auto animation = AnimationOf(track, *speaker, frames);
  if (!animation) return tl::unexpected(animation.error());
  outcome.reports.push_back(std::move(animation->report));
  OutputSet outputs;
  outputs.Add(folder / "animation.glb", std::move(animation->output));
  outputs.Add(folder / "parameters.csv", WriteParameterCsv(track));
  outputs.AddWriter(folder / "parameters.h5", [&track](const std::filesystem::path& path) {
    return WriteParameterHdf5(track, path);
  });
  outputs.Add(folder / "residuals.csv", WriteResidualCsv(outcome.fit));
  outputs.Add(folder / "head_pose.csv", WriteHeadPoseCsv(outcome.head_pose));
  outputs.Add(folder / "binding.toml", WriteBinding(outcome.binding));
  outputs.Add(folder / "report.json", ReportsToJson(outcome.reports));
  outputs.Add(folder / "report.html", PageOf(outcome, *speaker, frames));
  return outputs;
}

}  // namespace articap
