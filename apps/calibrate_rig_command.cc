// SPDX-License-Identifier: MIT
#include "apps/calibrate_input.h"
#include "apps/calibrate_outputs.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "calib/rig_calibration.h"

namespace articap {
namespace {

struct RigArguments {
  BoardInput input;
  LensOptions lens;
  RigOptions rig;
  CalibrationOutput output{"", "first"};
};

Result<StageReport> RunRig(const RigArguments& arguments, const BoardSpec& board) {
  // How the board moves between pictures is seen in those that follow one another.
  const bool choose_views = !arguments.rig.free_time_offsets;
  Result<std::vector<SeenCamera>> seen = SeeCameras(board, arguments.input, choose_views);
  if (!seen) return tl::unexpected(seen.error());
  std::vector<CameraSightings> cameras;
  std::vector<std::string> set_aside;
  for (SeenCamera& camera : *seen) {
    for (const std::string& sentence : camera.set_aside)
      set_aside.push_back(camera.sightings.camera + ": " + sentence);
    cameras.push_back(std::move(camera.sightings));
  }
  auto rig = WithProgress("calibrating the cameras", [&] {
    return CalibrateRig(board, cameras, arguments.lens, arguments.rig);
  });
  if (!rig) return Fail(WithReasons(rig.error().message, set_aside));
  AddWarnings(set_aside, rig->report);
  if (const auto written = WriteCalibrationOutputs(rig->output, rig->report, arguments.output,
                                                   arguments.input.paths);
      !written)
    return tl::unexpected(written.error());
  return rig->report;
}

}  // namespace

ExitCode CalibrateRigCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap calibrate rig",
                "Where two cameras or more stand, and their lenses, from pictures or videos of a\n"
                "board that they see together. Pictures of one instant have the same number in\n"
                "their names; videos are synchronous, or see --free-time-offsets.",
                "articap calibrate rig --board charuco:7x5:12:9 left/ right/ -o calibration.toml");
  RigArguments values;
  line.Arguments("DIR|VIDEO|TAKE", values.input.paths,
                 "a folder of pictures or a video a camera; or a take with several cameras");
  AddBoardInput(line, values.input);
  line.Flag("-o,--output", values.output.path, "FILE", "calibration to write, TOML")->required();
  line.Flag("--stage", values.output.stage, "FRAME",
            "stage frame: first, camera:NAME, or board:PICTURE in which the board lay still");
  line.Stage("lens", values.lens, "lens");
  line.Stage("rig", values.rig);
  if (const auto exit = line.Parse(arguments)) return *exit;
  const Result<BoardSpec> board = ParseBoardSpec(values.input.board);
  if (!board) return FailWith(ExitCode::kWrongUsage, board.error().message);
  const Result<StageReport> report = RunRig(values, *board);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
