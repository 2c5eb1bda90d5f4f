// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/calibrate_input.h"
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

// To be asked before anything is looked through. CheckStageName: whether it names a stage at all;
// of a wand "l-frame" too. RefuseToReplaceInputs: no output takes the place of a file that is read.
Result<void> CheckStageName(const CalibrationOutput& output, bool has_l_frame = false);
Result<void> RefuseToReplaceInputs(const CalibrationOutput& output,
                                   const std::vector<std::filesystem::path>& inputs);

// Moves the stage, writes the report beside the output (json and html) and, where the calibration
// is usable, the output itself: nothing that cannot be relied on is left where it could be used. An
// output of an earlier calibration stays where this one is not usable, which the report then says.
Result<void> WriteCalibrationOutputs(Calibration& calibration, StageReport& report,
                                     const CalibrationOutput& output);
Result<void> WriteWandOutputs(const WandCalibration& wand, StageReport& report,
                              const CalibrationOutput& output);

// What became of the pictures: after a failure that may come of it; as warnings, notes and part of
// the figure "set_aside" of a report.
std::string WithReasons(const std::string& message, const SeenCamera& seen);
void AddWhatWasSeen(const SeenCamera& seen, StageReport& report);

}  // namespace articap
