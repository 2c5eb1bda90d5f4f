// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <utility>

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
  const BoardInput& input = arguments.input;
  if (const auto told = RequireToldCorners(board); !told) return tl::unexpected(told.error());
  // How the board moves between pictures is seen in those that follow one another.
  const bool choose_views = !arguments.rig.free_time_offsets;
  Result<std::vector<SeenCamera>> seen = SeeCameras(board, input, choose_views);
  if (!seen) return tl::unexpected(seen.error());
  std::vector<CameraSightings> cameras;
  SeenCamera all;
  for (SeenCamera& camera : *seen) {
    if (arguments.rig.free_time_offsets && !camera.is_video)
      return Fail(fmt::format(
          "{}: separate pictures have no times, by which the cameras' clocks could be compared; "
          "give videos, or do without --free-time-offsets",
          camera.sightings.camera));
    for (const std::string& sentence : camera.set_aside)
      all.set_aside.push_back(camera.sightings.camera + ": " + sentence);
    all.notes.insert(all.notes.end(), camera.notes.begin(), camera.notes.end());
    cameras.push_back(std::move(camera.sightings));
  }
  auto rig = WithProgress("calibrating the cameras", [&] {
    return CalibrateRig(board, cameras, arguments.lens, arguments.rig);
  });
  return Conclude(std::move(rig), all, arguments.output);
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
  return RunOnBoard(line, values.input, values.output,
                    [&](const BoardSpec& board) { return RunRig(values, board); });
}

}  // namespace articap
