// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/resources.h"
#include "apps/rig_input.h"
#include "apps/verbs.h"
#include "synthetic/take_files.h"

namespace articap {
namespace {

StageReport DescribeTake(const SyntheticTake& take, const DisturbedRecording& disturbed,
                         const std::string& folder) {
  const StageTracks& tracks = disturbed.markers.tracks;
  StageReport report;
  report.stage = "synthesize";
  report.verdict = fmt::format("{} frames of {} markers at {} Hz ({:.1f} s) written to {}",
                               tracks.num_frames(), tracks.num_markers(), tracks.rate_hz(),
                               tracks.num_frames() / tracks.rate_hz(), folder);
  for (const NamedValue& slider : take.identity)
    report.figures.emplace_back("identity_" + slider.name, slider.value);
  report.figures.emplace_back("dropped_samples", disturbed.Count(SampleFault::kDropout));
  report.figures.emplace_back("samples_in_gaps", disturbed.Count(SampleFault::kGap));
  report.figures.emplace_back("outliers", disturbed.Count(SampleFault::kOutlier));
  report.figures.emplace_back("swapped_samples", disturbed.Count(SampleFault::kSwap));
  report.options = take.options;
  return report;
}

Result<SyntheticTake> Synthesize(const std::string& rig_folder, const std::string& map,
                                 const SyntheticTakeOptions& options) {
  const Result<FaceRig> rig = ChooseRig(rig_folder);
  if (!rig) return tl::unexpected(rig.error());
  const auto map_path = FindMap(map);
  if (!map_path) return tl::unexpected(map_path.error());
  const Result<MarkerSet> set = ReadMarkerSet(*map_path);
  if (!set) return tl::unexpected(set.error());
  return WithProgress("synthesizing", [&] { return SynthesizeTake(*rig, *set, options); });
}

}  // namespace

ExitCode SynthesizeCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap synthesize",
                "A recording of somebody who never lived, with the truth about it: take.c3d,\n"
                "markers.toml, labels.TextGrid, truth.csv, truth.pose.csv, truth.toml,\n"
                "truth.faults.csv in the folder OUT.",
                "articap synthesize take01 --sentences 5 --seed 7 --noise-mm 0.2 --dropout 0.02");
  std::string folder, rig_folder, map = "spectacles30";
  SyntheticTakeOptions take_options;
  SyntheticNoiseOptions noise_options;
  line.Argument("OUT", folder, "folder to write");
  line.Flag("--rig", rig_folder, "DIR", "folder of the speaker's rig; else the default head");
  line.Flag("--map", map, "NAME|FILE", "which markers are worn, and where")->capture_default_str();
  line.Stage("synthesize", take_options);
  line.Stage("noise", noise_options);
  if (const auto exit = line.Parse(arguments)) return *exit;

  if (const auto checked = CheckOptions(noise_options); !checked) return FailWith(checked.error());
  const Result<SyntheticTake> take = Synthesize(rig_folder, map, take_options);
  if (!take) return FailWith(take.error());
  const DisturbedRecording disturbed =
      AddNoise(take->markers, noise_options, static_cast<std::uint64_t>(take_options.seed));
  OutputSet outputs;
  for (OutputFile& file : FilesOf(*take, disturbed, noise_options))
    outputs.Add(std::filesystem::path(folder) / file.name, std::move(file.bytes));
  if (const auto allowed = outputs.RefuseToOverwrite({MapInput(map), line.config_path()}); !allowed)
    return FailWith(allowed.error());
  if (const auto written = outputs.Commit(); !written) return FailWith(written.error());
  StageReport report = DescribeTake(*take, disturbed, folder);
  for (auto& option : EchoOptions(noise_options)) report.options.push_back(std::move(option));
  return line.Finish({report});
}

}  // namespace articap
