// SPDX-License-Identifier: MIT
#include <utility>

#include "apps/calibrate_input.h"
#include "apps/calibrate_outputs.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "calib/lens_calibration.h"

namespace articap {
namespace {

Result<StageReport> RunLens(const BoardInput& input, const BoardSpec& board,
                            const LensOptions& options, const CalibrationOutput& output) {
  Result<SeenCamera> seen = SeeOneCamera(board, input);
  if (!seen) return tl::unexpected(seen.error());
  auto lens = WithProgress("calibrating the lens",
                           [&] { return CalibrateLens(board, seen->sightings, options); });
  return Conclude(std::move(lens), *seen, output);
}

}  // namespace

ExitCode CalibrateLensCommand(const std::vector<std::string>& arguments) {
  VerbLine line("articap calibrate lens",
                "One camera's lens, from pictures or a video of a board that is held before it in\n"
                "many places, tilted to all sides. Says how good it is; report beside the output.",
                "articap calibrate lens --board chessboard:9x6:25 left*.jpg -o left.toml");
  BoardInput input;
  LensOptions options;
  CalibrationOutput output{"", "first"};
  line.Arguments("PICTURES|VIDEO", input.paths, "picture files, a folder of them, or a video");
  AddBoardInput(line, input);
  line.Flag("-o,--output", output.path, "FILE", "calibration to write, TOML")->required();
  line.Stage("lens", options);
  if (const auto exit = line.Parse(arguments)) return *exit;
  return RunOnBoard(line, input, output,
                    [&](const BoardSpec& board) { return RunLens(input, board, options, output); });
}

}  // namespace articap
