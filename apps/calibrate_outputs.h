// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

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

// Moves the stage, writes the report beside the output (json and html) and, where the calibration
// is usable, the output itself: nothing that cannot be relied on is left where it could be used.
Result<void> WriteCalibrationOutputs(Calibration& calibration, const StageReport& report,
                                     const CalibrationOutput& output,
                                     const std::vector<std::string>& inputs);
Result<void> WriteWandOutputs(const WandCalibration& wand, const StageReport& report,
                              const CalibrationOutput& output,
                              const std::vector<std::string>& inputs);

// Why pictures were not used, after a failure that may come of it; as warnings of a report.
std::string WithReasons(const std::string& message, const std::vector<std::string>& set_aside);
void AddWarnings(const std::vector<std::string>& set_aside, StageReport& report);

}  // namespace articap
