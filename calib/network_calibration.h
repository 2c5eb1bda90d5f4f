// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "calib/calibration.h"
#include "calib/calibration_report.h"
#include "calib/lens_calibration.h"
#include "calib/network_screening.h"
#include "core/report.h"

namespace articap {

// What rigs and mirrors are calibrated from, once it is roughly known where everything is.
struct NetworkStart {
  Network network;
  AdjustOptions adjust;
  std::vector<LensModel> models;  // one a camera
  LeftOutSightings set_aside;
  std::vector<std::string> warnings;
};

// Adjusts, screens, simplifies the lenses, and says how good what comes out is, as the stage
// `kind`. The report's options are the caller's.
StageResult<Calibration> CalibrateNetwork(const std::string& kind,
                                          const std::vector<CameraSightings>& inputs,
                                          NetworkStart start, const LensOptions& lens_options,
                                          const ScreenOptions& screen,
                                          const CalibrationLimits& limits);

}  // namespace articap
