// SPDX-License-Identifier: MIT
#include "apps/calibrate_input.h"
#include "apps/calibrate_outputs.h"
#include "apps/progress.h"
#include "apps/verbs.h"
#include "calib/lens_calibration.h"

namespace articap {
namespace {

Result<StageReport> RunLens(const BoardInput& input, const BoardSpec& board,
                            const LensOptions& options, const CalibrationOutput& output) {
  if (const auto kept = RefuseToReplaceInputs(output, InputFiles(input.paths, input.lenses)); !kept)
    return tl::unexpected(kept.error());
  Result<SeenCamera> seen = SeeOneCamera(board, input);
  if (!seen) return tl::unexpected(seen.error());
  auto lens = WithProgress("calibrating the lens",
                           [&] { return CalibrateLens(board, seen->sightings, options); });
  if (!lens) return Fail(WithReasons(lens.error().message, *seen));
  AddWhatWasSeen(*seen, lens->report);
  if (const auto written = WriteCalibrationOutputs(lens->output, lens->report, output); !written)
    return tl::unexpected(written.error());
  return lens->report;
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
  const Result<BoardSpec> board = ParseBoardSpec(input.board);
  if (!board) return FailWith(ExitCode::kWrongUsage, board.error().message);
  const Result<StageReport> report = RunLens(input, *board, options, output);
  return report ? line.Finish({*report}) : FailWith(report.error());
}

}  // namespace articap
