// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/resources.h"
#include "apps/rig_input.h"
#include "apps/verbs.h"
#include "core/marker_io.h"
#include "synthetic/noise.h"
#include "synthetic/speaker.h"
#include "synthetic/text_grid_writer.h"

namespace articap {
namespace {

// The truth in the form of a binding: identity, size and where each marker really sits.
Binding TrueBinding(const SyntheticTake& take) {
  Binding binding;
  binding.rig_name = take.rig_name;
  binding.marker_set = take.marker_set;
  binding.rig_from_head = take.rig_from_head;
  binding.rig_identity = take.identity;
  for (const std::string& name : take.truth.names) binding.rig_parameters.push_back({name, 0});
  binding.virtual_markers = take.true_attachments;
  return binding;
}

OutputSet OutputsOf(const SyntheticTake& take, const MarkerRecording& markers, MarkerFormat format,
                    const std::string& path) {
  OutputSet outputs;
  outputs.Add(path, FormatMarkers(markers, format));
  outputs.Add(Beside(path, ".TextGrid"), WriteTextGrid(take.labels));
  outputs.Add(Beside(path, ".map.toml"), WriteMarkerSet(take.marker_set));
  outputs.Add(Beside(path, ".truth.csv"), WriteParameterCsv(take.truth));
  outputs.Add(Beside(path, ".truth.pose.csv"), WriteHeadPoseCsv(take.true_pose));
  outputs.Add(Beside(path, ".truth.binding.toml"), WriteBinding(TrueBinding(take)));
  return outputs;
}

StageReport DescribeTake(const SyntheticTake& take, const DisturbedRecording& disturbed,
                         const OutputSet& outputs) {
  const StageTracks& tracks = disturbed.markers.tracks;
  StageReport report;
  report.stage = "synthesize";
  report.verdict =
      fmt::format("{} frames of {} markers at {} Hz, {:.1f} s", tracks.num_frames(),
                  tracks.num_markers(), tracks.rate_hz(), tracks.num_frames() / tracks.rate_hz());
  for (const auto& path : outputs.paths()) report.texts.emplace_back("written", path.string());
  for (const NamedValue& slider : take.identity)
    report.figures.emplace_back("identity_" + slider.name, slider.value);
  report.figures.emplace_back("dropped_samples", disturbed.Count(SampleFault::kDropout));
  report.figures.emplace_back("samples_in_gaps", disturbed.Count(SampleFault::kGap));
  report.figures.emplace_back("outliers", disturbed.Count(SampleFault::kOutlier));
  report.figures.emplace_back("swapped_samples", disturbed.Count(SampleFault::kSwap));
  report.options = take.options;
  return report;
}

}  // namespace

ExitCode SynthesizeCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap synthesize",
                "A recording of somebody who never lived, with the truth beside it: OUT's stem\n"
                "+ .TextGrid, .map.toml, .truth.csv, .truth.pose.csv, .truth.binding.toml",
                "articap synthesize take.c3d --sentences 5 --seed 7 --noise-mm 0.2 --dropout 0.02");
  std::string output, rig_folder, map = "spectacles30";
  SyntheticTakeOptions take_options;
  SyntheticNoiseOptions noise_options;
  line.Argument("OUT", output, "marker file to write; its ending says the format");
  line.Flag("--rig", rig_folder, "DIR", "folder of the speaker's rig; else the default head");
  line.Flag("--map", map, "NAME|FILE", "which markers are worn, and where")->capture_default_str();
  line.Stage("synthesize", take_options);
  line.Stage("noise", noise_options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  const Result<MarkerFormat> format = MarkerFormatOf(output);
  if (!format) return FailWith(ExitCode::kWrongUsage, format.error().message);
  const Result<FaceRig> rig = LoadRig(rig_folder);
  if (!rig) return FailWith(rig.error());
  const auto map_path = FindMap(map);
  if (!map_path) return FailWith(map_path.error());
  const Result<MarkerSet> set = ReadMarkerSet(*map_path);
  if (!set) return FailWith(set.error());
  const Result<SyntheticTake> take =
      WithProgress("synthesizing", [&] { return SynthesizeTake(*rig, *set, take_options); });
  if (!take) return FailWith(take.error());
  const DisturbedRecording disturbed =
      AddNoise(take->markers, noise_options, static_cast<std::uint64_t>(take_options.seed));
  const OutputSet outputs = OutputsOf(*take, disturbed.markers, *format, output);
  if (const auto written = outputs.Commit(); !written) return FailWith(written.error());
  StageReport report = DescribeTake(*take, disturbed, outputs);
  for (auto& option : EchoOptions(noise_options)) report.options.push_back(std::move(option));
  return line.Finish({report});
}

}  // namespace articap
