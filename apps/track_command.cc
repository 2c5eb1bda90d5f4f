// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>

#include "apps/calibrate_input.h"
#include "apps/camera_input.h"
#include "apps/corrections_input.h"
#include "apps/mirror_regions.h"
#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/review_outputs.h"
#include "apps/template_input.h"
#include "apps/track_detection.h"
#include "apps/track_pictures.h"
#include "apps/uncalibrated.h"
#include "apps/verbs.h"
#include "core/camera_io.h"
#include "core/check.h"
#include "core/marker_io.h"
#include "core/view_regions.h"
#include "tracking/apply_corrections.h"
#include "tracking/fill_gaps.h"
#include "tracking/labelled_markers.h"
#include "tracking/learn_template.h"
#include "tracking/reconstruct.h"
#include "tracking/synchronize.h"

namespace articap {
namespace {

constexpr int kFirstFrame = 1;  // of what is written, by C3D's custom

struct TrackArguments {
  std::vector<std::string> paths, view_regions;
  std::string output, cameras, config, corrections;
  TemplateInput naming;
  UncalibratedInput uncalibrated;
  CameraReadOptions read;
  DetectionOptions detect;
  SynchronizeOptions synchronize;
  ReconstructOptions reconstruct;
  LabelOptions label;
  FillOptions fill;
  ShowOptions show;
};

Result<void> CheckOptions(const TrackArguments& arguments) {
  if (auto checked = CheckOptions(arguments.detect.dots); !checked) return checked;
  if (auto checked = CheckOptions(arguments.synchronize); !checked) return checked;
  if (auto checked = CheckOptions(arguments.reconstruct); !checked) return checked;
  if (auto checked = CheckOptions(arguments.fill); !checked) return checked;
  if (auto checked = CheckOptions(arguments.show); !checked) return checked;
  return CheckOptions(arguments.label);
}

struct TrackedMarkers {
  std::vector<DotVideo> videos;
  SynchronizedDots dots;
  PointClouds clouds;
  MarkerTemplate marker_template;
  Labelling labelling;
};

Result<TrackedMarkers> Follow(const TrackArguments& arguments, const CameraArray& array,
                              std::span<const DetectedVideo> detected,
                              AppliedCorrections& corrections) {
  TrackedMarkers result;
  for (const DetectedVideo& one : detected) result.videos.push_back(one.video);
  result.dots = Synchronize(array, result.videos, arguments.synchronize);
  corrections.CorrectDots(array, result.dots.instants);
  result.clouds = {result.dots.rate_hz, kFirstFrame, result.dots.start,
                   Reconstruct(array, result.dots.instants, arguments.reconstruct)};
  Result<MarkerTemplate> marker_template =
      TemplateFor(arguments.naming, result.clouds, LikelyAttitudes(array), arguments.label);
  if (!marker_template) return tl::unexpected(marker_template.error());
  result.marker_template = std::move(*marker_template);
  if (const auto known = corrections.CheckMarkers(result.marker_template); !known)
    return tl::unexpected(known.error());
  result.labelling = corrections.Label(result.clouds, result.marker_template, arguments.label,
                                       array, result.dots.instants);
  return result;
}

// The same by a nominal camera and mirror, which replace `array`. A known length waits for labels:
// everything is found twice then.
Result<TrackedMarkers> FollowNominally(TrackArguments arguments, CameraArray& array,
                                       std::span<const DetectedVideo> detected,
                                       AppliedCorrections& corrections,
                                       std::optional<NominalTake>& nominal) {
  Result<NominalTake> started =
      NominalTake::Start(arguments.uncalibrated, arguments.naming, array, detected.front().video);
  if (!started) return tl::unexpected(started.error());
  double& calibration_px = arguments.reconstruct.calibration_px;
  calibration_px = std::max(calibration_px, started->sigma_px());
  if (started->needs_length()) {
    // A template that was learnt before is of the right size, and this is not.
    TrackArguments rehearsal = arguments;
    rehearsal.naming.known.clear();
    AppliedCorrections rehearsed = corrections;
    const auto rough = Follow(rehearsal, started->array(), detected, rehearsed);
    if (!rough) return tl::unexpected(rough.error());
    if (const auto scaled =
            started->ScaleTo(rough->clouds, rough->marker_template, rough->labelling);
        !scaled)
      return tl::unexpected(scaled.error());
  }
  nominal = *std::move(started);
  array = nominal->array();
  return Follow(arguments, array, detected, corrections);
}

Result<StageResult<MarkerRecording>> Fill(const TrackArguments& arguments, const CameraArray& array,
                                          const TrackedMarkers& tracked,
                                          const AppliedCorrections& corrections) {
  auto filled =
      FillGaps(RecordingOf(tracked.clouds, tracked.marker_template, tracked.labelling, array),
               arguments.fill);
  if (filled) corrections.ClearFillsAcrossSplits(tracked.labelling, filled->output);
  return filled;
}

// What was noticed before a stage failed may be why.
std::string WithReasons(std::string message, const StageReport& earlier) {
  for (const std::string& warning : earlier.warnings) message += "\n  " + warning;
  return message;
}

// What else the inputs are beside the videos and the calibration.
std::vector<std::filesystem::path> InputsOf(const TrackArguments& arguments) {
  std::vector<std::filesystem::path> inputs = InputFiles(arguments.paths, {arguments.cameras});
  for (const std::string& input :
       {arguments.naming.known, arguments.naming.layout, arguments.config, arguments.corrections})
    inputs.emplace_back(input);
  return inputs;
}

// `written`: the markers as the file has them, which need not be in the stage.
Result<void> WriteTracked(const TrackArguments& arguments, const CameraArray& array,
                          const std::vector<DetectedVideo>& videos, const TrackedMarkers& tracked,
                          const MarkerRecording& markers, const MarkerRecording& written,
                          MarkerFormat format, const std::vector<StageReport>& reports) {
  const auto& instants = tracked.dots.instants;
  const StageTracks& tracks = markers.tracks;
  const TakeReview review = ReviewOf(tracked.clouds, tracked.labelling, markers, array, instants);
  const PicturedTake take = {
      .array = array,
      .videos = tracked.videos,
      .open = [&] { return OpenAgain(array, arguments.paths, videos); },
      .names = tracks.names(),
      .marks = {array, tracked.clouds, tracked.labelling, tracks, review, instants},
      .rate_hz = tracks.rate_hz(),
      .start = tracks.start(),
      .first_frame = tracks.first_frame()};
  OutputSet outputs;
  outputs.Add(arguments.output, FormatMarkers(written, format));
  if (arguments.naming.known.empty())
    outputs.Add(Beside(arguments.output, ".template.toml"),
                WriteMarkerTemplate(tracked.marker_template));
  const auto shown =
      AddReview(arguments.output, review, DoubtsOf(review, tracked.labelling, tracks), reports,
                take, arguments.show, outputs);
  if (!shown) return shown;
  if (auto allowed = outputs.RefuseToOverwrite(InputsOf(arguments)); !allowed) return allowed;
  return outputs.Commit();
}

// Without a calibration, nothing but names and sizes until dots were seen.
Result<CameraArray> ArrayOf(const TrackArguments& arguments) {
  Result<CameraArray> array = arguments.uncalibrated.enabled
                                  ? NominalTake::ArrayOf(arguments.paths)
                                  : ReadCameras(arguments.cameras, arguments.read);
  if (!array) return array;
  if (const auto set = SetViewRegions(arguments.view_regions, *array); !set)
    return tl::unexpected(set.error());
  return array;
}

// Before one mirror the dots themselves may show which are its.
void SplitByDots(const TrackArguments& arguments, const std::vector<DetectedVideo>& videos,
                 CameraArray& array, StageReport& report) {
  const std::vector<std::string> regions =
      RegionsByDots(array, videos.front().video, arguments.reconstruct);
  if (regions.empty()) return;
  ARTICAP_CHECK(SetViewRegions(regions, array).has_value());
  report.texts.emplace_back("view_regions",
                            fmt::format("by the dots: {}", fmt::join(regions, ",")));
}

Result<std::vector<StageReport>> RunTrack(const TrackArguments& arguments) {
  if (const auto checked = CheckOptions(arguments); !checked)
    return tl::unexpected(checked.error());
  const Result<MarkerFormat> format = MarkerFormatOf(arguments.output);
  if (!format) return tl::unexpected(format.error());
  Result<CameraArray> array = ArrayOf(arguments);
  if (!array) return tl::unexpected(array.error());
  Result<AppliedCorrections> corrections =
      CorrectionsOf(arguments.corrections, kFirstFrame, *array);
  if (!corrections) return tl::unexpected(corrections.error());
  const Result<std::vector<DetectedVideo>> videos =
      DetectVideos(*array, arguments.paths, arguments.detect, RoomForPictures(arguments.show));
  if (!videos) return tl::unexpected(videos.error());
  StageReport detection = DescribeDetection(*videos, arguments.detect);
  if (!detection.IsUsable()) return std::vector<StageReport>{detection};
  if (!arguments.uncalibrated.enabled) SplitByDots(arguments, *videos, *array, detection);
  std::optional<NominalTake> nominal;
  const Result<TrackedMarkers> tracked = WithProgress("tracking", [&] {
    return arguments.uncalibrated.enabled
               ? FollowNominally(arguments, *array, *videos, *corrections, nominal)
               : Follow(arguments, *array, *videos, *corrections);
  });
  if (!tracked) return Fail(WithReasons(tracked.error().message, detection));
  const StageReport report = DescribeLabelling(tracked->clouds, tracked->marker_template,
                                               tracked->labelling, arguments.label);
  const auto filled =
      WithProgress("filling gaps", [&] { return Fill(arguments, *array, *tracked, *corrections); });
  if (!filled) return tl::unexpected(filled.error());
  const Result<MarkerRecording> markers =
      nominal ? nominal->RelativeToNose(filled->output) : filled->output;
  if (!markers) return tl::unexpected(markers.error());
  if (const auto limit = LimitExceeded(*markers, *format))
    return Fail(fmt::format("the recording has {}; write another format", *limit));
  std::vector<StageReport> reports = {detection, report, filled->report};
  if (!corrections->empty()) reports.push_back(corrections->Report());
  if (nominal) reports.push_back(nominal->Report(*markers));
  if (const auto written = WriteTracked(arguments, *array, *videos, *tracked, filled->output,
                                        *markers, *format, reports);
      !written)
    return tl::unexpected(written.error());
  for (const std::string& loss : LossesOf(*markers, *format)) reports[1].warnings.push_back(loss);
  return reports;
}

}  // namespace

ExitCode TrackCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap track",
      "Follows the dots on a speaker's face in the videos of calibrated cameras, with or\n"
      "without mirrors, and writes them as labelled markers in 3D. What was learnt of\n"
      "the speaker goes to OUT's stem + .template.toml, and labels further takes.",
      "articap track take01.mp4 --cameras calibration.toml --map mirror6 -o take01.c3d");
  TrackArguments values;
  line.Arguments("VIDEO", values.paths, "the videos, one a camera, or a take");
  line.Flag("--cameras", values.cameras, "FILE", "calibration of the cameras and mirrors");
  AddUncalibratedInput(line, values.uncalibrated);
  line.Flag("-o,--output", values.output, "FILE",
            "marker file to write; its ending says the format")
      ->required();
  line.Flag(
      "--view-regions", values.view_regions, "VIEW=WxH+X+Y,...",
      "where the picture shows a view alone, as front/left=640x720+640+0: width, height, left "
      "and top in px");
  AddTemplateInput(line, values.naming);
  AddCorrectionsFlag(line, values.corrections);
  line.Stage("read", values.read);
  line.Stage("detect", values.detect.dots);
  line.Stage("detect", values.detect.perspective);
  line.Stage("synchronize", values.synchronize);
  line.Stage("reconstruct", values.reconstruct);
  line.Stage("label", values.label);
  line.Stage("fill", values.fill, "fill");
  line.Stage("show", values.show);
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  if (const auto checked = CheckInput(values.uncalibrated, values.cameras, values.naming); !checked)
    return FailWith(ExitCode::kWrongUsage, checked.error().message);
  const auto reports = RunTrack(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
