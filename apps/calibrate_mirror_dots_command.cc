// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "apps/calibrate_input.h"
#include "apps/calibrate_outputs.h"
#include "apps/camera_input.h"
#include "apps/output_names.h"
#include "apps/output_set.h"
#include "apps/verbs.h"
#include "calib/mirror_dots.h"
#include "core/calibration_toml.h"
#include "core/io/camera_parts.h"

namespace articap {
namespace {

struct DotArguments {
  std::string dots;
  std::string lenses;
  double focal_px = 0;
  std::string output;
  MirrorDotsOptions options;
  CameraReadOptions read;
};

Result<Camera> RoughCamera(double focal_px, const std::string& size) {
  const Result<Eigen::Vector2i> side_px = ParsePictureSize(size);
  if (!side_px) return Fail("--size: " + side_px.error().message);
  return Camera{.name = "camera",
                .width = side_px->x(),
                .height = side_px->y(),
                .lens = CentredLens(focal_px, side_px->x(), side_px->y())};
}

Result<Camera> CameraOf(const DotArguments& arguments) {
  if (!arguments.lenses.empty()) {
    const Result<CameraArray> cameras = ReadCameras(arguments.lenses, arguments.read);
    if (!cameras) return tl::unexpected(cameras.error());
    if (cameras->cameras.size() != 1)
      return Fail(fmt::format("{}: holds {} cameras; give a calibration of one", arguments.lenses,
                              cameras->cameras.size()));
    Camera camera = cameras->cameras[0];
    camera.cam_from_stage = {};
    return camera;
  }
  if (!(arguments.focal_px > 0))
    return Fail(
        "--lenses names the calibration of the camera's lens; where nobody knows it, give "
        "--focal-px and --size");
  return RoughCamera(arguments.focal_px, arguments.read.size);
}

Result<StageReport> RunDots(const DotArguments& arguments) {
  const std::vector<std::filesystem::path> inputs = {arguments.dots, arguments.lenses};
  if (const auto kept = RefuseToReplaceInputs({arguments.output, "first"}, inputs); !kept)
    return tl::unexpected(kept.error());
  const Result<Camera> camera = CameraOf(arguments);
  if (!camera) return tl::unexpected(camera.error());
  const Result<std::vector<DotPair>> dots = ReadDotPairs(arguments.dots);
  if (!dots) return tl::unexpected(dots.error());
  auto mirror = CalibrateMirrorFromDots(*camera, *dots, arguments.options);
  if (!mirror) return tl::unexpected(mirror.error());
  mirror->output.array.source = "articap calibrate mirror-dots";
  WarnOfEarlierOutput(arguments.output, mirror->report);
  OutputSet outputs;
  if (mirror->report.IsUsable())
    outputs.Add(arguments.output, WriteCalibration(mirror->output.array));
  outputs.Add(Beside(arguments.output, ".report.json"), mirror->report.ToJson());
  if (const auto written = outputs.Commit(); !written) return tl::unexpected(written.error());
  return mirror->report;
}

}  // namespace

ExitCode CalibrateMirrorDotsCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap calibrate mirror-dots",
      "A mirror without any board: from dots of the face seen directly and in the mirror,\n"
      "one length that is known, and a lens that is known at least roughly. The sigmas\n"
      "are honest, and larger than a board's.",
      "articap calibrate mirror-dots dots.csv --lenses lens.toml --length-from left_hinge "
      "--length-to right_hinge --length-mm 141 -o calibration.toml");
  DotArguments values;
  line.Argument("DOTS", values.dots,
                "CSV: frame,marker,x_px,y_px,mirror_x_px,mirror_y_px, a row a dot and picture");
  line.Flag("--lenses", values.lenses, "FILE", "calibration of the camera's lens");
  line.Flag("--focal-px", values.focal_px, "X", "instead: its focal length, roughly; with --size");
  line.Flag("-o,--output", values.output, "FILE", "calibration to write, TOML")->required();
  line.Stage("mirror_dots", values.options);
  line.Stage("read", values.read);
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<StageReport> report = RunDots(values);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
