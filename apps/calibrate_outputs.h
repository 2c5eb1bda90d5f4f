// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/calibrate_input.h"
#include "apps/verb_line.h"
#include "calib/calibration.h"
#include "calib/wand_calibration.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

// Where a calibration goes, and which stage frame it has.
struct CalibrationOutput {
  std::string path;   // calibration.toml; the report is written beside it
  std::string stage;  // "first", "camera:NAME", "board:PICTURE"
};

// What the verbs of boards do with their line, once it is parsed: checks the board, the stage and
// that no input is replaced, runs, and prints what came out.
ExitCode RunOnBoard(const VerbLine& line, const BoardInput& input, const CalibrationOutput& output,
                    const std::function<Result<StageReport>(const BoardSpec&)>& run);

// What a calibration from a board gave: moves the stage, writes the report beside the output (json
// and html) and, where the calibration is usable, the output itself: nothing that cannot be relied
// on is left where it could be used. An output of an earlier calibration stays where this one is
// not usable, which the report then says. The report, or the failure, also tells what became of the
// pictures.
Result<StageReport> Conclude(Result<StageResult<Calibration>> calibration, const SeenCamera& seen,
                             const CalibrationOutput& output);

// To be asked before anything is looked through. CheckStageName: whether it names a stage at all;
// of a wand "l-frame" too. RefuseToReplaceInputs: no output takes the place of a file that is read.
Result<void> CheckStageName(const CalibrationOutput& output, bool has_l_frame = false);
Result<void> RefuseToReplaceInputs(const CalibrationOutput& output,
                                   const std::vector<std::filesystem::path>& inputs);

// Says so where this calibration is not usable, and an earlier one's output stays in its place.
void WarnOfEarlierOutput(const std::string& path, StageReport& report);

// The same of a wand, whose stage was moved already.
Result<void> WriteWandOutputs(const WandCalibration& wand, StageReport& report,
                              const CalibrationOutput& output);

}  // namespace articap
