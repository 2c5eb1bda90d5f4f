// SPDX-License-Identifier: MIT
#include "apps/track_detection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/progress.h"
#include "core/statistics.h"

namespace articap {
namespace {

Result<void> RefuseOtherSize(const Camera& camera, const FrameSourceInfo& info) {
  if (camera.width == info.width && camera.height == info.height) return {};
  return Fail(fmt::format(
      "{}: its pictures are {}x{}, but camera '{}' was calibrated for {}x{}; calibrate it as it "
      "records, or record as it was calibrated",
      info.name, info.width, info.height, camera.name, camera.width, camera.height));
}

std::size_t CountDots(const DotVideo& video) {
  std::size_t dots = 0;
  for (const DotPicture& picture : video.pictures) dots += picture.dots.size();
  return dots;
}

double ShareOfSaturated(const DotVideo& video) {
  std::size_t saturated = 0;
  for (const DotPicture& picture : video.pictures)
    saturated += static_cast<std::size_t>(std::count_if(
        picture.dots.begin(), picture.dots.end(), [](const Dot& dot) { return dot.saturated; }));
  return static_cast<double>(saturated) /
         static_cast<double>(std::max<std::size_t>(1, CountDots(video)));
}

double MedianDiameter_px(const DotVideo& video) {
  std::vector<double> diameters_px;
  for (const DotPicture& picture : video.pictures)
    for (const Dot& dot : picture.dots) diameters_px.push_back(dot.diameter_px());
  return MedianOf(std::move(diameters_px));
}

// The file promises more frames than came. Durations are rounded, hence a margin.
bool EndsEarly(const DetectedVideo& detected) {
  const auto came = static_cast<double>(detected.video.pictures.size());
  const auto promised = static_cast<double>(detected.frames_promised);
  return came + std::max(2.0, 0.02 * promised) < promised;
}

void AddWarnings(const DetectedVideo& detected, std::vector<std::string>& warnings) {
  const DotVideo& video = detected.video;
  const auto warn = [&](const std::string& what) {
    warnings.push_back(fmt::format("{}: {}", video.camera, what));
  };
  for (const std::string& note : detected.notes) warn(note);
  if (EndsEarly(detected))
    warn(
        fmt::format("the video breaks off: {} of about {} frames are there, and were tracked; copy "
                    "it again from the camera",
                    video.pictures.size(), detected.frames_promised));
  if (detected.damaged > 0)
    warn(fmt::format("{} frames are damaged; look at what was found in them", detected.damaged));
  if (detected.crowded > 0)
    warn(
        fmt::format("{} frames have more that looks like dots than are kept; raise "
                    "--min-contrast, or --most-dots",
                    detected.crowded));
  if (detected.overexposed > 0)
    warn(
        fmt::format("{} frames are overexposed, most of them as bright as the file can say; "
                    "expose for less, or with less light",
                    detected.overexposed));
  constexpr double kManySaturated = 0.2;
  if (const double share = ShareOfSaturated(video); share > kManySaturated)
    warn(
        fmt::format("{:.0f} % of the dots are saturated, and their centres less sure; expose for "
                    "less",
                    100 * share));
}

// Why nothing can be made of the dots; empty where something can.
std::string WhatForbids(const std::vector<DetectedVideo>& videos) {
  std::size_t frames = 0, dots = 0;
  int overexposed = 0;
  for (const DetectedVideo& detected : videos) {
    const std::size_t of_video = detected.video.pictures.size();
    if (of_video > 0 && 2 * static_cast<std::size_t>(detected.crowded) > of_video)
      return fmt::format(
          "{}: most frames show more that looks like dots than markers can be: raise "
          "--min-contrast, narrow --min-diameter-px and --max-diameter-px, or say with --regions "
          "where the face is",
          detected.video.camera);
    frames += of_video;
    dots += CountDots(detected.video);
    overexposed += detected.overexposed;
  }
  if (dots > 0) return "";
  if (2 * static_cast<std::size_t>(overexposed) > frames)
    return fmt::format(
        "no dots in {} frames: they are overexposed, so that dots are no brighter than the rest; "
        "expose for less, or with less light",
        frames);
  return fmt::format(
      "no dots in {} frames: are they dark (--polarity dark), smaller or larger than "
      "--min-diameter-px and --max-diameter-px, or fainter than --min-contrast?",
      frames);
}

// Which names are given that nobody expects, and which are not given.
Result<void> CheckNames(const CameraArray& array, const std::vector<NamedSource>& sources) {
  std::vector<std::string> cameras, videos;
  for (const Camera& camera : array.cameras) cameras.push_back(camera.name);
  for (const NamedSource& named : sources) videos.push_back(named.name);
  for (const std::string& video : videos)
    if (std::find(cameras.begin(), cameras.end(), video) == cameras.end())
      return Fail(fmt::format(
          "video '{}' has no calibration: no camera is called so, only {}; calibrate it with the "
          "others, or leave it out. Videos are known by the names of their files or folders, or by "
          "the cameras' names in a take",
          video, fmt::join(cameras, ", ")));
  for (const std::string& camera : cameras)
    if (std::find(videos.begin(), videos.end(), camera) == videos.end())
      return Fail(fmt::format(
          "there is no video of camera '{}' of the calibration, only {}; videos are known by the "
          "names of their files or folders, or by the cameras' names in a take",
          camera, fmt::join(videos, ", ")));
  return {};
}

}  // namespace

Result<std::vector<NamedSource>> OpenVideosOf(const CameraArray& array,
                                              const std::vector<std::string>& paths) {
  Result<std::vector<NamedSource>> sources = OpenCameras(paths);
  if (!sources) return sources;
  if (sources->size() == 1 && array.cameras.size() == 1) return sources;
  if (const auto known = CheckNames(array, *sources); !known) return tl::unexpected(known.error());
  std::vector<NamedSource> ordered;
  for (const Camera& camera : array.cameras)
    ordered.push_back(
        std::move(*std::find_if(sources->begin(), sources->end(), [&](const NamedSource& named) {
          return named.source && named.name == camera.name;
        })));
  return ordered;
}

Result<std::vector<NamedSource>> OpenAgain(const CameraArray& array,
                                           const std::vector<std::string>& paths,
                                           const std::vector<DetectedVideo>& videos) {
  const bool all_kept = std::all_of(videos.begin(), videos.end(),
                                    [](const DetectedVideo& video) { return video.pictures; });
  if (!all_kept) return OpenVideosOf(array, paths);
  std::vector<NamedSource> sources;
  for (const DetectedVideo& video : videos)
    sources.push_back({video.video.camera, OpenStored(video.pictures)});
  return sources;
}

Result<std::vector<DetectedVideo>> DetectVideos(const CameraArray& array,
                                                const std::vector<std::string>& paths,
                                                const DetectionOptions& options,
                                                std::size_t room_bytes) {
  Result<std::vector<NamedSource>> sources = OpenVideosOf(array, paths);
  if (!sources) return tl::unexpected(sources.error());
  std::vector<DetectedVideo> videos;
  for (std::size_t camera = 0; camera < sources->size(); ++camera) {
    NamedSource& named = (*sources)[camera];
    if (const auto same = RefuseOtherSize(array.cameras[camera], named.source->info()); !same)
      return tl::unexpected(same.error());
    const Lens& lens = array.cameras[camera].lens;
    auto detected =
        WithProgress(fmt::format("looking for dots in {}", named.name), [&](Progress& progress) {
          return DetectVideo(named, lens, options, room_bytes, progress);
        });
    if (!detected) return tl::unexpected(detected.error());
    videos.push_back(std::move(*detected));
  }
  return videos;
}

StageReport DescribeDetection(const std::vector<DetectedVideo>& videos,
                              const DetectionOptions& options) {
  StageReport report;
  report.stage = "detect";
  ReportTable table = {
      "cameras",
      {"frames", "dots_a_frame", "median_diameter_px", "saturated_percent", "perspective_px"},
      {}};
  std::size_t frames = 0, dots = 0;
  for (const DetectedVideo& detected : videos) {
    const DotVideo& video = detected.video;
    const std::size_t of_video = CountDots(video);
    frames += video.pictures.size();
    dots += of_video;
    table.rows.push_back({video.camera,
                          {static_cast<double>(video.pictures.size()),
                           static_cast<double>(of_video) /
                               static_cast<double>(std::max<std::size_t>(1, video.pictures.size())),
                           MedianDiameter_px(video), 100 * ShareOfSaturated(video),
                           std::sqrt(detected.perspective2_px2 /
                                     static_cast<double>(std::max<std::size_t>(1, of_video)))}});
    AddWarnings(detected, report.warnings);
  }
  const std::string forbids = WhatForbids(videos);
  report.usable = forbids.empty();
  report.verdict = report.usable ? fmt::format("{} dots in {} frames", dots, frames) : forbids;
  report.tables = {table};
  report.options = EchoOptions(options.dots);
  for (auto& entry : EchoOptions(options.perspective)) report.options.push_back(std::move(entry));
  return report;
}

}  // namespace articap
