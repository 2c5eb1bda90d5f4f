// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "apps/calibrate_input.h"
#include "apps/calibrate_outputs.h"
#include "apps/camera_input.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "calib/stage_frame.h"
#include "calib/wand_calibration.h"
#include "calib/wand_detector.h"
#include "capture/open_frames.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

struct WandArguments {
  std::vector<std::string> paths;
  std::vector<std::string> lenses;
  double focal_px = 0;
  std::string l_frame;
  std::vector<std::string> l_frame_mm;
  SpotOptions spots;
  WandOptions wand;
  CameraReadOptions read;
  CalibrationOutput output{"", "first"};
};

Result<Lens> LensOf(const WandArguments& arguments, const KnownLenses& lenses,
                    const WandVideo& video) {
  if (arguments.focal_px > 0) return CentredLens(arguments.focal_px, video.width, video.height);
  if (lenses.cameras.empty())
    return Fail(
        "--lenses names the calibrations with the cameras' lenses ('articap calibrate lens' makes "
        "one a camera); where nobody knows them, give --focal-px roughly, and --adjust-focal");
  return lenses.LensFor(video.camera, false, video.width, video.height);
}

Result<std::vector<WandVideo>> SeeWand(const WandArguments& arguments) {
  const Result<std::vector<NamedSource>> sources = OpenCameras(arguments.paths);
  if (!sources) return tl::unexpected(sources.error());
  const Result<KnownLenses> lenses = ReadLenses(arguments.lenses, arguments.read);
  if (!lenses) return tl::unexpected(lenses.error());
  std::vector<WandVideo> videos;
  for (const NamedSource& named : *sources) {
    Result<WandVideo> video =
        WithProgress("looking for the wand in " + named.name, [&](Progress& progress) {
          return FindWand(*named.source, arguments.spots,
                          [&](double part) { progress.SetPart(part); });
        });
    if (!video) return tl::unexpected(video.error());
    video->camera = named.name;
    const Result<Lens> lens = LensOf(arguments, *lenses, *video);
    if (!lens) return tl::unexpected(lens.error());
    video->lens = *lens;
    videos.push_back(*std::move(video));
  }
  return videos;
}

// FOLDER/<camera> or FOLDER/<camera>.<anything>: what that camera shows of the L-frame.
Result<std::string> LFramePath(const std::string& folder, const std::string& camera) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().stem() == camera) return entry.path().string();
  return Fail(fmt::format("{}: holds neither a folder nor a picture nor a video called {}", folder,
                          camera));
}

// Of the first picture with three markers those; none where there is no such picture.
Result<std::vector<Eigen::Vector2d>> SeeLFrame(const std::string& path,
                                               const SpotOptions& options) {
  const auto source = OpenFrames({path});
  if (!source) return tl::unexpected(source.error());
  const Result<WandVideo> seen = FindWand(**source, options);
  if (!seen) return tl::unexpected(seen.error());
  for (const WandPicture& picture : seen->pictures)
    if (picture.points_px.size() == 3) return picture.points_px;
  return std::vector<Eigen::Vector2d>{};
}

Result<LFrame> LFrameOf(const std::vector<std::string>& lengths_mm) {
  const auto length = [&](std::size_t i) {
    return i < lengths_mm.size() ? std::strtod(lengths_mm[i].c_str(), nullptr) : 0;
  };
  const LFrame frame{length(0), length(1)};
  if (lengths_mm.size() != 2 || !(frame.short_mm > 0) || !(frame.long_mm > frame.short_mm))
    return Fail("--l-frame-mm: give the long arm and the short one, as 200,120");
  return frame;
}

Result<Rigid3d> StageOf(const WandArguments& arguments, const WandCalibration& wand,
                        StageReport& report) {
  if (arguments.output.stage == "first") return Rigid3d{};
  if (arguments.output.stage.starts_with("camera:"))
    return StageOfCamera(wand.array, arguments.output.stage.substr(7));
  const Result<LFrame> frame = LFrameOf(arguments.l_frame_mm);
  if (!frame) return tl::unexpected(frame.error());
  std::vector<std::vector<Eigen::Vector2d>> points_px;
  for (const Camera& camera : wand.array.cameras) {
    const Result<std::string> path = LFramePath(arguments.l_frame, camera.name);
    if (!path) return tl::unexpected(path.error());
    Result<std::vector<Eigen::Vector2d>> seen = SeeLFrame(*path, arguments.spots);
    if (!seen) return tl::unexpected(seen.error());
    points_px.push_back(*std::move(seen));
  }
  const Result<LFrameStage> stage = StageOfLFrame(wand.array, points_px, *frame);
  if (!stage) return tl::unexpected(stage.error());
  report.figures.insert(report.figures.end(),
                        {{"l_frame_long_mm", stage->long_found_mm},
                         {"l_frame_short_mm", stage->short_found_mm},
                         {"l_frame_angle_deg", stage->angle_found_rad * 180 / M_PI}});
  return stage->new_from_old;
}

Result<StageReport> RunWand(const WandArguments& arguments) {
  if (const auto kept =
          RefuseToReplaceInputs(arguments.output, InputFiles(arguments.paths, arguments.lenses));
      !kept)
    return tl::unexpected(kept.error());
  const Result<std::vector<WandVideo>> videos = SeeWand(arguments);
  if (!videos) return tl::unexpected(videos.error());
  auto wand = WithProgress("calibrating the cameras",
                           [&] { return CalibrateWand(*videos, arguments.wand); });
  if (!wand) return tl::unexpected(wand.error());
  const Result<Rigid3d> stage = StageOf(arguments, wand->output, wand->report);
  if (!stage) return tl::unexpected(stage.error());
  MoveStage(wand->output.parameters, wand->output.covariance, *stage, wand->output.array);
  wand->output.array.source = "articap calibrate wand";
  if (const auto written = WriteWandOutputs(wand->output, wand->report, arguments.output); !written)
    return tl::unexpected(written.error());
  return wand->report;
}

}  // namespace

ExitCode CalibrateWandCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap calibrate wand",
      "Where several cameras stand, and how their clocks differ, from a wand with two\n"
      "bright markers that is waved slowly through the volume.",
      "articap calibrate wand --length-mm 120 --lenses lenses.toml a.mp4 b.mp4 -o c.toml");
  WandArguments values;
  line.Arguments("VIDEO|DIR|TAKE", values.paths,
                 "a video or a folder of pictures a camera; or a take with several cameras");
  line.Flag("--lenses", values.lenses, "FILE,...", "calibrations with the lenses of these cameras");
  line.Flag("--focal-px", values.focal_px, "X", "instead: their focal length, roughly");
  line.Flag("-o,--output", values.output.path, "FILE", "calibration to write, TOML")->required();
  line.Flag("--stage", values.output.stage, "FRAME",
            "stage frame: first (the first camera's), camera:NAME, or l-frame");
  line.Flag("--l-frame", values.l_frame, "DIR",
            "pictures of an L-frame of three markers, a file or folder called as each camera");
  line.Flag("--l-frame-mm", values.l_frame_mm, "LONG,SHORT", "the lengths of its arms");
  line.Stage("wand", values.wand);
  line.Stage("spots", values.spots, "spot");
  line.Stage("read", values.read);
  if (const auto exit = line.Parse(arguments)) return *exit;
  if (const auto stage = CheckStageName(values.output, /*has_l_frame=*/true); !stage)
    return FailWith(ExitCode::kWrongUsage, stage.error().message);
  const Result<StageReport> report = RunWand(values);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
