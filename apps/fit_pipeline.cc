// SPDX-License-Identifier: MIT
#include "apps/fit_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/progress.h"
#include "core/file_io.h"

namespace articap {
namespace {

Result<FitOutcome> FitStabilized(const Take& take, Stabilized stabilized, Binding binding,
                                 const FaceRig& rig, const PipelineOptions& options,
                                 const FrameRange& binding_frames,
                                 std::vector<StageReport> reports) {
  const HeadTracks& tracks = stabilized.tracks;
  auto fit =
      WithProgress(fmt::format("fitting {} frames", tracks.num_frames()), [&](Progress& progress) {
        return Fit(tracks, binding, rig, options.fit, binding_frames,
                   [&progress](double part) { progress.SetPart(part); });
      });
  if (!fit) return tl::unexpected(fit.error());
  reports.push_back(std::move(fit->report));
  return FitOutcome{take.path.stem().string(),       std::move(binding),
                    std::move(stabilized.head_pose), std::move(stabilized.head_shape),
                    std::move(fit->output),          std::move(reports)};
}

// The head references, and besides them every marker of the reference pose: those on the skull or
// the nose are witnesses by which the stabilisation finds spectacles that were re-seated.
std::optional<HeadShape> SharedShape(const Binding& binding) {
  if (binding.head_shape.points.empty()) return std::nullopt;
  HeadShape shape = binding.head_shape;
  for (const NamedPoint& point : binding.reference_pose.points)
    if (shape.Find(point.name) == nullptr) shape.points.push_back(point);
  return shape;
}

// The frames that the binding was made from, where that was this very file: they say nothing about
// how well it explains a take.
Result<FrameRange> BindingFramesIn(const Take& take, const Binding& binding) {
  const auto reference = std::ranges::find(binding.sources, "reference", &SourceHash::role);
  if (reference == binding.sources.end()) return FrameRange{};
  const Result<std::string> bytes = ReadFile(take.path);
  if (!bytes) return tl::unexpected(bytes.error());
  return HashOf(*bytes) == reference->xxh3 ? binding.reference_frames : FrameRange{};
}

}  // namespace

Result<BoundReference> BindTake(const Take& reference, const MarkerSet& set, const FaceRig& rig,
                                const PipelineOptions& options) {
  auto stabilized = StabilizeTake(reference, set, std::nullopt, options.stabilize);
  if (!stabilized) return tl::unexpected(stabilized.error());
  auto bound = WithProgress("binding " + reference.path.string(), [&] {
    return Bind(stabilized->output.tracks, stabilized->output.head_shape, set, rig, options.bind);
  });
  if (!bound) return Fail(fmt::format("{}: {}", reference.path.string(), bound.error().message));
  // Other takes of the speaker are to be stabilised in the same way.
  auto chosen = ChosenSet(set, options.stabilize);
  if (!chosen) return tl::unexpected(chosen.error());
  bound->output.marker_set = *std::move(chosen);
  return BoundReference{
      std::move(bound->output),
      std::move(stabilized->output),
      {reference.report, std::move(stabilized->report), std::move(bound->report)}};
}

Result<FitOutcome> FitBoundTake(const Take& take, const Binding& binding, const FaceRig& rig,
                                const PipelineOptions& options) {
  auto stabilized =
      StabilizeTake(take, binding.marker_set, SharedShape(binding), options.stabilize);
  if (!stabilized) return tl::unexpected(stabilized.error());
  const auto binding_frames = BindingFramesIn(take, binding);
  if (!binding_frames) return tl::unexpected(binding_frames.error());
  std::vector<StageReport> reports = {take.report, stabilized->report};
  return FitStabilized(take, std::move(stabilized->output), binding, rig, options, *binding_frames,
                       std::move(reports));
}

Result<FitOutcome> FitTakeByItself(const Take& take, const MarkerSet& set, const FaceRig& rig,
                                   const PipelineOptions& options) {
  auto bound = BindTake(take, set, rig, options);
  if (!bound) return tl::unexpected(bound.error());
  const FrameRange binding_frames = bound->binding.reference_frames;
  return FitStabilized(take, std::move(bound->stabilized), std::move(bound->binding), rig, options,
                       binding_frames, std::move(bound->reports));
}

Result<void> LabelFrames(const TextGrid& labels, const std::string& tier, FitOutcome& outcome) {
  const auto phones = FindPhoneTier(labels, tier);
  if (!phones) return tl::unexpected(phones.error());
  ParameterTrack& track = outcome.fit.parameters;
  std::vector<SessionTime> times;
  for (int frame = 0; frame < track.num_frames(); ++frame)
    times.push_back(TimeOfFrame(frame, track.rate_hz, track.start));
  track.phones = LabelsOfFrames(**phones, times);

  const auto num_labelled =
      std::ranges::count_if(track.phones, [](const std::string& phone) { return !phone.empty(); });
  const auto num_frames = track.num_frames();
  if (num_labelled == 0 && num_frames > 0)
    return Fail(fmt::format(
        "no frame of the take has a label: it lasts from {:.3f} to {:.3f} s, the tier '{}' from "
        "{:.3f} to {:.3f} s; are these its labels?",
        SecondsOf(times.front()), SecondsOf(times.back()), (*phones)->name, labels.start_s,
        labels.end_s));
  StageReport& report = outcome.reports.back();
  report.figures.emplace_back("frames_labelled", static_cast<double>(num_labelled));
  if (2 * num_labelled < num_frames)
    report.warnings.push_back(
        fmt::format("only {} of {} frames have a label: do the labels belong to this take, and do "
                    "both count time from the same moment?",
                    num_labelled, num_frames));
  return {};
}

}  // namespace articap
