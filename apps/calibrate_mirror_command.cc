// SPDX-License-Identifier: MIT
#include <utility>

#include "apps/calibrate_input.h"
#include "apps/calibrate_outputs.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "calib/mirror_calibration.h"

namespace articap {
namespace {

struct MirrorArguments {
  BoardInput input;
  LensOptions lens;
  MirrorOptions mirror;
  CalibrationOutput output{"", "first"};
};

Result<StageReport> RunMirror(const MirrorArguments& arguments, const BoardSpec& board) {
  BoardInput input = arguments.input;
  if (const auto told = RequireToldCorners(board); !told) return tl::unexpected(told.error());
  input.detect.look_in_mirror = true;
  Result<SeenCamera> seen = SeeOneCamera(board, input);
  if (!seen) return tl::unexpected(seen.error());
  auto mirror = WithProgress("calibrating the mirror", [&] {
    return CalibrateMirror(board, seen->sightings, arguments.lens, arguments.mirror);
  });
  return Conclude(std::move(mirror), *seen, arguments.output);
}

}  // namespace

ExitCode CalibrateMirrorCommand(const std::vector<std::string>& arguments) {
  VerbLine line(
      "articap calibrate mirror",
      "A camera's lens and the mirrors in its picture, from pictures or a video in which\n"
      "the board shows both directly and in the mirror.",
      "articap calibrate mirror --board chessboard:9x6:12 board.mp4 -o calibration.toml");
  MirrorArguments values;
  line.Arguments("PICTURES|VIDEO", values.input.paths,
                 "picture files, a folder of them, or a video");
  AddBoardInput(line, values.input);
  line.Flag("-o,--output", values.output.path, "FILE", "calibration to write, TOML")->required();
  line.Flag("--stage", values.output.stage, "FRAME",
            "stage frame: first (the camera's), or board:PICTURE in which the board lay still");
  line.Stage("lens", values.lens, "lens");
  line.Stage("mirror", values.mirror);
  if (const auto exit = line.Parse(arguments)) return *exit;
  return RunOnBoard(line, values.input, values.output,
                    [&](const BoardSpec& board) { return RunMirror(values, board); });
}

}  // namespace articap
