// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/resources.h"
#include "apps/rig_input.h"
#include "apps/synthesize_video.h"
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

struct SynthesizeArguments {
  std::string folder, rig_folder, map = "spectacles30";
  SyntheticTakeOptions take;
  SyntheticNoiseOptions noise;
  SynthesizeVideoOptions video;
  SensorOptions sensor = MachineVision();

  bool is_filmed() const { return !video.cameras.empty(); }
};

Result<void> CheckOptions(const SynthesizeArguments& arguments) {
  if (auto valid = CheckOptions(arguments.noise); !valid) return valid;
  return CheckOptions(arguments.video, arguments.sensor, arguments.take.speech.rate_hz);
}

Result<SyntheticTake> Synthesize(const FaceRig& rig, const SynthesizeArguments& arguments) {
  const auto map_path = FindMap(arguments.map);
  if (!map_path) return tl::unexpected(map_path.error());
  Result<MarkerSet> set = ReadMarkerSet(*map_path);
  if (!set) return tl::unexpected(set.error());
  SyntheticTakeOptions options = arguments.take;
  if (arguments.is_filmed()) {
    options.speaker_ahead = true;
    set = WithDots(*std::move(set), arguments.video.film.look);
  }
  return WithProgress("synthesizing", [&] { return SynthesizeTake(rig, *set, options); });
}

// The options beyond the take's own, by their tables.
std::vector<NamedOptions> FurtherOptions(const SynthesizeArguments& arguments) {
  if (!arguments.is_filmed()) return {};
  return {{"video", EchoOptions(arguments.video)}, {"sensor", EchoOptions(arguments.sensor)}};
}

Result<void> WriteTake(const SynthesizeArguments& arguments, const std::string& config_path,
                       const FaceRig& rig, const SyntheticTake& take,
                       const DisturbedRecording& disturbed) {
  OutputSet outputs;
  for (OutputFile& file : FilesOf(take, disturbed, arguments.noise, FurtherOptions(arguments)))
    outputs.Add(std::filesystem::path(arguments.folder) / file.name, std::move(file.bytes));
  if (arguments.is_filmed()) {
    const FilmedSpeaker speaker(rig, take, arguments.video.film.look);
    if (auto added = AddVideo(speaker, arguments.video, arguments.sensor, arguments.take.seed,
                              arguments.folder, outputs);
        !added)
      return added;
  }
  if (auto allowed = outputs.RefuseToOverwrite({MapInput(arguments.map), config_path}); !allowed)
    return allowed;
  return outputs.Commit();
}

Result<StageReport> RunSynthesize(const SynthesizeArguments& arguments,
                                  const std::string& config_path) {
  if (const auto checked = CheckOptions(arguments); !checked)
    return tl::unexpected(checked.error());
  const Result<FaceRig> rig = ChooseRig(arguments.rig_folder);
  if (!rig) return tl::unexpected(rig.error());
  const Result<SyntheticTake> take = Synthesize(*rig, arguments);
  if (!take) return tl::unexpected(take.error());
  const DisturbedRecording disturbed =
      AddNoise(take->markers, arguments.noise, static_cast<std::uint64_t>(arguments.take.seed));
  if (const auto written = WriteTake(arguments, config_path, *rig, *take, disturbed); !written)
    return tl::unexpected(written.error());
  StageReport report = DescribeTake(*take, disturbed, arguments.folder);
  std::vector<NamedOptions> further = FurtherOptions(arguments);
  further.insert(further.begin(), {"noise", EchoOptions(arguments.noise)});
  for (const NamedOptions& more : further)
    report.options.insert(report.options.end(), more.options.begin(), more.options.end());
  return report;
}

}  // namespace

ExitCode SynthesizeCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap synthesize",
                "A recording of somebody who never lived, with the truth about it: take.c3d,\n"
                "markers.toml, labels.TextGrid, truth.csv, truth.pose.csv, truth.toml,\n"
                "truth.faults.csv in the folder OUT. With --video also the videos of cameras that\n"
                "film the speaker with its dots, and truth.calibration.toml, truth.dots.csv.",
                "articap synthesize take01 --sentences 5 --seed 7 --noise-mm 0.2 --dropout 0.02");
  SynthesizeArguments values;
  line.Argument("OUT", values.folder, "folder to write");
  line.Flag("--rig", values.rig_folder, "DIR",
            "folder of the speaker's rig; else the default head");
  line.Flag("--map", values.map, "NAME|FILE", "which markers are worn, and where")
      ->capture_default_str();
  line.Stage("synthesize", values.take);
  line.Stage("noise", values.noise);
  line.Stage("video", values.video);
  line.Stage("sensor", values.sensor, "sensor");
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<StageReport> report = RunSynthesize(values, line.config_path());
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
