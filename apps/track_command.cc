// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "apps/calibrate_input.h"
#include "apps/camera_input.h"
#include "apps/corrections_input.h"
#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/progress.h"
#include "apps/review_outputs.h"
#include "apps/template_input.h"
#include "apps/track_pictures.h"
#include "apps/verbs.h"
#include "core/camera_io.h"
#include "core/marker_io.h"
#include "tracking/apply_corrections.h"
#include "tracking/dot_detector.h"
#include "tracking/fill_gaps.h"
#include "tracking/labelled_markers.h"
#include "tracking/learn_template.h"
#include "tracking/reconstruct.h"
#include "tracking/synchronize.h"

namespace articap {
namespace {

constexpr int kFirstFrame = 1;  // of what is written, by C3D's custom

struct TrackArguments {
  std::vector<std::string> paths;
  std::string output, cameras, config, corrections;
  TemplateInput naming;
  CameraReadOptions read;
  DotDetectorOptions detect;
  SynchronizeOptions synchronize;
  ReconstructOptions reconstruct;
  LabelOptions label;
  FillOptions fill;
  ShowOptions show;
};

Result<void> CheckOptions(const TrackArguments& arguments) {
  if (auto checked = CheckOptions(arguments.detect); !checked) return checked;
  if (auto checked = CheckOptions(arguments.synchronize); !checked) return checked;
  if (auto checked = CheckOptions(arguments.reconstruct); !checked) return checked;
  if (auto checked = CheckOptions(arguments.fill); !checked) return checked;
  if (auto checked = CheckOptions(arguments.show); !checked) return checked;
  return CheckOptions(arguments.label);
}

// A camera's dots, and what went wrong on the way.
struct DetectedVideo {
  DotVideo video;
  std::vector<std::string> notes;
  int crowded = 0;  // frames with more dots than are looked at
};

Result<DetectedVideo> DetectAll(NamedSource& named, const DotDetectorOptions& options,
                                Progress& progress) {
  const FrameSourceInfo info = named.source->info();
  DetectedVideo result;
  result.video = {.camera = named.name,
                  .width = info.width,
                  .height = info.height,
                  .rate_hz = info.rate_hz,
                  .constant_rate = info.constant_rate};
  result.notes = info.notes;
  DotDetector detector(options);
  while (true) {
    Result<std::optional<Frame>> frame = named.source->Next();
    if (!frame) {
      // What came before stays good: half a recording is better than none.
      if (result.video.pictures.empty()) return tl::unexpected(frame.error());
      result.notes.push_back(fmt::format("{}; tracked up to there", frame.error().message));
      return result;
    }
    if (!*frame) return result;
    result.video.pictures.push_back(
        {(*frame)->index, (*frame)->time,
         detector.Detect((*frame)->image, (*frame)->picture_from_image)});
    if (detector.report().too_many) ++result.crowded;
    if (info.frames > 0)
      progress.SetPart(static_cast<double>((*frame)->index) / static_cast<double>(info.frames));
  }
}

double DotsAFrame(const DotVideo& video) {
  std::size_t dots = 0;
  for (const DotPicture& picture : video.pictures) dots += picture.dots.size();
  return static_cast<double>(dots) /
         static_cast<double>(std::max<std::size_t>(1, video.pictures.size()));
}

// Cameras of the calibration in the order of their videos.
Result<std::vector<NamedSource>> OpenVideosOf(const CameraArray& array,
                                              const std::vector<std::string>& paths) {
  Result<std::vector<NamedSource>> sources = OpenCameras(paths);
  if (!sources) return sources;
  if (sources->size() == 1 && array.cameras.size() == 1) return sources;
  std::vector<NamedSource> ordered;
  for (const Camera& camera : array.cameras) {
    const auto found = std::find_if(
        sources->begin(), sources->end(),
        [&](const NamedSource& named) { return named.source && named.name == camera.name; });
    if (found == sources->end())
      return Fail(fmt::format(
          "there is no video of camera '{}' of the calibration; videos are known by the names of "
          "their files or folders, or by the cameras' names in a take",
          camera.name));
    ordered.push_back(std::move(*found));
  }
  if (ordered.size() != sources->size())
    return Fail(fmt::format("there are {} videos, but the calibration has {} cameras",
                            sources->size(), ordered.size()));
  return ordered;
}

Result<void> RefuseOtherSize(const Camera& camera, const FrameSourceInfo& info) {
  if (camera.width == info.width && camera.height == info.height) return {};
  return Fail(fmt::format(
      "{}: its pictures are {}x{}, but camera '{}' was calibrated for {}x{}; calibrate it as it "
      "records, or record as it was calibrated",
      info.name, info.width, info.height, camera.name, camera.width, camera.height));
}

StageReport DescribeDetection(const std::vector<DetectedVideo>& videos,
                              const DotDetectorOptions& options) {
  StageReport report;
  report.stage = "detect";
  ReportTable table = {"cameras", {"frames", "dots_a_frame", "median_diameter_px"}, {}};
  std::size_t frames = 0, dots = 0;
  for (const DetectedVideo& detected : videos) {
    const DotVideo& video = detected.video;
    std::vector<double> diameters_px;
    for (const DotPicture& picture : video.pictures) {
      dots += picture.dots.size();
      for (const Dot& dot : picture.dots) diameters_px.push_back(dot.diameter_px());
    }
    frames += video.pictures.size();
    std::sort(diameters_px.begin(), diameters_px.end());
    table.rows.push_back(
        {video.camera,
         {static_cast<double>(video.pictures.size()), DotsAFrame(video),
          diameters_px.empty() ? std::nan("") : diameters_px[diameters_px.size() / 2]}});
    for (const std::string& note : detected.notes)
      report.warnings.push_back(fmt::format("{}: {}", video.camera, note));
    if (detected.crowded > 0)
      report.warnings.push_back(
          fmt::format("{}: {} frames have more that looks like dots than are kept; raise "
                      "--min-contrast, or --most-dots",
                      video.camera, detected.crowded));
  }
  report.usable = dots > 0;
  report.verdict = dots > 0
                       ? fmt::format("{} dots in {} frames", dots, frames)
                       : fmt::format(
                             "no dots in {} frames: are they dark (--polarity dark), smaller or "
                             "larger than --min-diameter-px and --max-diameter-px, or fainter than "
                             "--min-contrast?",
                             frames);
  report.tables = {table};
  report.options = EchoOptions(options);
  return report;
}

Result<std::vector<DetectedVideo>> DetectVideos(const TrackArguments& arguments,
                                                const CameraArray& array) {
  Result<std::vector<NamedSource>> sources = OpenVideosOf(array, arguments.paths);
  if (!sources) return tl::unexpected(sources.error());
  std::vector<DetectedVideo> videos;
  for (std::size_t camera = 0; camera < sources->size(); ++camera) {
    NamedSource& named = (*sources)[camera];
    if (const auto same = RefuseOtherSize(array.cameras[camera], named.source->info()); !same)
      return tl::unexpected(same.error());
    auto detected = WithProgress(
        fmt::format("looking for dots in {}", named.name),
        [&](Progress& progress) { return DetectAll(named, arguments.detect, progress); });
    if (!detected) return tl::unexpected(detected.error());
    videos.push_back(std::move(*detected));
  }
  return videos;
}

struct TrackedMarkers {
  std::vector<DotVideo> videos;
  SynchronizedDots dots;
  PointClouds clouds;
  MarkerTemplate marker_template;
  Labelling labelling;
};

Result<TrackedMarkers> Follow(const TrackArguments& arguments, const CameraArray& array,
                              const std::vector<DetectedVideo>& detected,
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

// What else the inputs are beside the videos and the calibration.
std::vector<std::filesystem::path> InputsOf(const TrackArguments& arguments) {
  std::vector<std::filesystem::path> inputs = InputFiles(arguments.paths, {arguments.cameras});
  for (const std::string& input :
       {arguments.naming.known, arguments.naming.layout, arguments.config, arguments.corrections})
    inputs.emplace_back(input);
  return inputs;
}

Result<void> WriteTracked(const TrackArguments& arguments, const CameraArray& array,
                          const TrackedMarkers& tracked, const MarkerRecording& markers,
                          MarkerFormat format, const std::vector<StageReport>& reports) {
  const auto& instants = tracked.dots.instants;
  const StageTracks& tracks = markers.tracks;
  const TakeReview review = ReviewOf(tracked.clouds, tracked.labelling, markers, array, instants);
  const PicturedTake take = {
      .array = array,
      .videos = tracked.videos,
      .open = [&] { return OpenVideosOf(array, arguments.paths); },
      .names = tracks.names(),
      .marks = {array, tracked.clouds, tracked.labelling, tracks, review, instants},
      .rate_hz = tracks.rate_hz(),
      .start = tracks.start(),
      .first_frame = tracks.first_frame()};
  OutputSet outputs;
  outputs.Add(arguments.output, FormatMarkers(markers, format));
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

Result<std::vector<StageReport>> RunTrack(const TrackArguments& arguments) {
  if (const auto checked = CheckOptions(arguments); !checked)
    return tl::unexpected(checked.error());
  const Result<MarkerFormat> format = MarkerFormatOf(arguments.output);
  if (!format) return tl::unexpected(format.error());
  const Result<CameraArray> array = ReadCameras(arguments.cameras, arguments.read);
  if (!array) return tl::unexpected(array.error());
  Result<AppliedCorrections> corrections = CorrectionsOf(arguments.corrections, kFirstFrame);
  if (!corrections) return tl::unexpected(corrections.error());
  if (const auto known = corrections->CheckViews(*array); !known)
    return tl::unexpected(known.error());
  const Result<std::vector<DetectedVideo>> videos = DetectVideos(arguments, *array);
  if (!videos) return tl::unexpected(videos.error());
  const StageReport detection = DescribeDetection(*videos, arguments.detect);
  if (!detection.IsUsable()) return std::vector<StageReport>{detection};
  const Result<TrackedMarkers> tracked =
      WithProgress("tracking", [&] { return Follow(arguments, *array, *videos, *corrections); });
  if (!tracked) return tl::unexpected(tracked.error());
  StageReport report = DescribeLabelling(tracked->clouds, tracked->marker_template,
                                         tracked->labelling, arguments.label);
  const auto filled = WithProgress("filling gaps", [&] {
    return FillGaps(
        RecordingOf(tracked->clouds, tracked->marker_template, tracked->labelling, *array),
        arguments.fill);
  });
  if (!filled) return tl::unexpected(filled.error());
  MarkerRecording markers = filled->output;
  corrections->ClearFillsAcrossSplits(tracked->labelling, markers);
  if (const auto limit = LimitExceeded(markers, *format))
    return Fail(fmt::format("the recording has {}; write another format", *limit));
  for (const std::string& loss : LossesOf(markers, *format)) report.warnings.push_back(loss);
  std::vector<StageReport> reports = {detection, report, filled->report};
  if (!corrections->empty()) reports.push_back(corrections->Report());
  if (const auto written = WriteTracked(arguments, *array, *tracked, markers, *format, reports);
      !written)
    return tl::unexpected(written.error());
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
  line.Flag("--cameras", values.cameras, "FILE", "calibration of the cameras and mirrors")
      ->required();
  line.Flag("-o,--output", values.output, "FILE",
            "marker file to write; its ending says the format")
      ->required();
  AddTemplateInput(line, values.naming);
  AddCorrectionsFlag(line, values.corrections);
  line.Stage("read", values.read);
  line.Stage("detect", values.detect);
  line.Stage("synchronize", values.synchronize);
  line.Stage("reconstruct", values.reconstruct);
  line.Stage("label", values.label);
  line.Stage("fill", values.fill, "fill");
  line.Stage("show", values.show);
  if (const auto exit = line.Parse(arguments)) return *exit;
  values.config = line.config_path();
  const auto reports = RunTrack(values);
  return reports ? line.Finish(*reports) : FailWith(reports.error());
}

}  // namespace articap
