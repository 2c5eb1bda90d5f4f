// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "apps/fit_outputs.h"
#include "apps/fit_pipeline.h"
#include "apps/marker_input.h"
#include "apps/progress.h"
#include "apps/resources.h"
#include "apps/rig_input.h"
#include "apps/take_input.h"
#include "apps/verbs.h"

namespace articap {
namespace {

struct FitArguments {
  std::string markers, binding, rig_folder, map, reference, labels, tier, window, output, config;
  double labels_shift_s = 0;
  std::optional<TimeSpan> span;
  PipelineOptions pipeline;
};

// A reference is a file, or else frames of the take itself.
bool IsReferenceFile(const FitArguments& arguments) {
  return arguments.reference.find_first_not_of("0123456789:") != std::string::npos;
}

// What cannot go together; the message, or nothing.
std::string WrongUsage(const FitArguments& arguments) {
  if (arguments.binding.empty() && arguments.map.empty())
    return "name the speaker's binding with --binding (made by 'articap bind'), or the marker map "
           "with --map to bind the take by itself";
  if (!arguments.binding.empty() && !(arguments.map.empty() && arguments.reference.empty()))
    return "--binding holds the map and the reference already; leave --map and --reference out";
  if (!arguments.binding.empty() &&
      EchoOptions(arguments.pipeline.bind) != EchoOptions(BindOptions()))
    return "--bind-... say how a speaker is bound, which --binding holds already; leave them out, "
           "or "
           "bind anew with 'articap bind'";
  if (!arguments.tier.empty() && arguments.labels.empty())
    return "--tier names a tier of the labels; give these with --labels";
  if (!arguments.reference.empty() && !arguments.pipeline.bind.frames.empty() &&
      !IsReferenceFile(arguments))
    return "--reference and --bind-frames both name frames; give one of them";
  return "";
}

Result<std::optional<TimeWindow>> ParseWindow(const std::string& text) {
  if (text.empty()) return std::nullopt;
  TimeWindow window;
  const std::size_t colon = text.find(':');
  const char* const end = text.data() + text.size();
  if (colon != std::string::npos) {
    const char* const middle = text.data() + colon;
    const auto first = std::from_chars(text.data(), middle, window.start_s);
    const auto second = std::from_chars(middle + 1, end, window.end_s);
    if (first.ec == std::errc() && first.ptr == middle && second.ec == std::errc() &&
        second.ptr == end && window.start_s <= window.end_s)
      return window;
  }
  return Fail(fmt::format("--window {}: give the seconds from and to, e.g. 2.5:10", text));
}

// By the binding given, by another take, or by the take itself.
Result<FitOutcome> FitByReference(const Take& take, const FaceRig& rig,
                                  const FitArguments& arguments) {
  PipelineOptions options = arguments.pipeline;
  if (!arguments.binding.empty()) {
    const Result<Binding> binding = ReadBinding(arguments.binding);
    if (!binding) return tl::unexpected(binding.error());
    return FitBoundTake(take, *binding, rig, options);
  }
  const Result<MarkerSet> set = ReadMap(arguments.map);
  if (!set) return tl::unexpected(set.error());
  const std::string reference_path =
      IsReferenceFile(arguments) ? arguments.reference : arguments.markers;
  const auto sources = SourcesOf(reference_path, arguments.map, rig);
  if (!sources) return tl::unexpected(sources.error());
  if (!IsReferenceFile(arguments)) {
    if (!arguments.reference.empty()) options.bind.frames = arguments.reference;
    Result<FitOutcome> outcome = FitTakeByItself(take, *set, rig, options);
    if (outcome) outcome->binding.sources = *sources;
    return outcome;
  }
  const Result<Take> reference = ReadTake(arguments.reference, options.read, options.mirror);
  if (!reference) return tl::unexpected(reference.error());
  Result<BoundReference> bound = BindTake(*reference, *set, rig, options);
  if (!bound) return tl::unexpected(bound.error());
  bound->binding.sources = *sources;
  return FitBoundTake(take, bound->binding, rig, options);
}

// A take of a session stands for its files, and for the map and the rig that the session names.
Result<void> ResolveTake(FitArguments& arguments) {
  const Result<TakeInput> input = FindTakeInput(arguments.markers, arguments.labels);
  if (!input) return tl::unexpected(input.error());
  arguments.markers = input->markers;
  arguments.labels = input->labels;
  arguments.labels_shift_s = input->labels_shift_s;
  arguments.span = input->span;
  if (arguments.binding.empty() && arguments.map.empty()) arguments.map = input->map;
  if (arguments.rig_folder.empty()) arguments.rig_folder = input->rig_folder;
  return {};
}

Result<void> AddLabels(const FitArguments& arguments, FitOutcome& outcome) {
  if (arguments.labels.empty()) return {};
  Result<TextGrid> labels = ReadTextGrid(arguments.labels);
  if (!labels) return tl::unexpected(labels.error());
  ShiftTimes(*labels, arguments.labels_shift_s);
  const Result<void> labelled = LabelFrames(*labels, arguments.tier, outcome);
  if (!labelled) return Fail(fmt::format("{}: {}", arguments.labels, labelled.error().message));
  return {};
}

Result<std::vector<StageReport>> RunFit(const FitArguments& arguments) {
  const auto window = ParseWindow(arguments.window);
  if (!window) return tl::unexpected(window.error());
  const Result<FaceRig> rig = ChooseRig(arguments.rig_folder);
  if (!rig) return tl::unexpected(rig.error());
  const Result<Take> take = ReadTake(arguments.markers, arguments.pipeline.read,
                                     arguments.pipeline.mirror, arguments.span);
  if (!take) return tl::unexpected(take.error());
  Result<FitOutcome> outcome = FitByReference(*take, *rig, arguments);
  if (!outcome) return tl::unexpected(outcome.error());
  if (const auto labelled = AddLabels(arguments, *outcome); !labelled)
    return tl::unexpected(labelled.error());

  const Result<OutputSet> outputs = FitOutputs(*outcome, *rig, *window, arguments.output);
  if (!outputs) return tl::unexpected(outputs.error());
  const auto allowed =
      outputs->RefuseToOverwrite({arguments.markers, arguments.binding, arguments.reference,
                                  arguments.labels, MapInput(arguments.map), arguments.config});
  if (!allowed) return tl::unexpected(allowed.error());
  const auto written = WithProgress("writing", [&] { return outputs->Commit(); });
  if (!written) return tl::unexpected(written.error());
  return outcome->reports;
}

}  // namespace

ExitCode FitCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap fit",
                "Markers in, articulatory parameters out: parameters.csv, parameters.h5,\n"
                "residuals.csv, head_pose.csv, report.json, report.html, animation.glb and\n"
                "binding.toml in the folder DIR.",
                "articap fit take01.c3d --binding anna.binding.toml -o take01\n"
                "  articap fit anna_01/takes/take01 -o anna_01/derived/take01\n"
                "  articap fit take01.c3d --map spectacles30 --labels take01.TextGrid -o take01");
  FitArguments values;
  line.Argument("MARKERS", values.markers,
                "marker file of the take, or the folder of a session's take");
  line.Flag("--binding", values.binding, "FILE", "the speaker's binding, from 'articap bind'");
  line.Flag("--map", values.map, "NAME|FILE",
            "marker map, where there is no binding: the take is bound by itself");
  line.Flag("--reference", values.reference, "FRAME|A:B|FILE",
            "the reference pose: frames of the take, or another take; else proposed");
  line.Flag("--rig", values.rig_folder, "DIR", "folder of a rig; else the default head");
  line.Flag("--labels", values.labels, "FILE",
            "Praat TextGrid: the phone of every frame; else the take's own");
  line.Flag("--tier", values.tier, "NAME", "its tier of phones, where the name does not say so");
  line.Flag("--window", values.window, "A:B", "seconds that the page and the animation play");
  line.Flag("-o,--output", values.output, "DIR", "folder of the results")->required();
  line.Flag("--mirror", values.pipeline.mirror, "the recording is mirrored; mirror it back");
  line.Stage("fit", values.pipeline.fit);
  line.Stage("read", values.pipeline.read);
  line.Stage("stabilize", values.pipeline.stabilize, "stabilize");
  line.Stage("bind", values.pipeline.bind, "bind");
  if (const auto exit = line.Parse(arguments)) return *exit;
  if (const Result<void> resolved = ResolveTake(values); !resolved)
    return FailWith(resolved.error());
  if (const std::string wrong = WrongUsage(values); !wrong.empty())
    return FailWith(ExitCode::kWrongUsage, wrong);
  values.config = line.config_path();
  const auto reports = RunFit(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
