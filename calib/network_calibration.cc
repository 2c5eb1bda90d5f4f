// SPDX-License-Identifier: MIT
#include "calib/network_calibration.h"

#include <utility>

#include "calib/held_out.h"
#include "calib/lens_model.h"

namespace articap {

StageResult<Calibration> CalibrateNetwork(const std::string& kind,
                                          const std::vector<CameraSightings>& inputs,
                                          NetworkStart start, const LensOptions& lens_options,
                                          const ScreenOptions& screen,
                                          const CalibrationLimits& limits) {
  AdjustedNetwork adjusted =
      AdjustAndScreen(std::move(start.network), start.adjust, screen, start.set_aside);
  if (lens_options.simplify)
    adjusted = SimplifyLenses(std::move(adjusted), lens_options, start.adjust, start.models);
  Calibration calibration = MakeCalibration(inputs, adjusted, start.set_aside);
  calibration.held_lenses = JudgeHeldLenses(adjusted, start.adjust);
  // A board that moves is nowhere the same in two pictures.
  if (!adjusted.network.moving) calibration.held_out = HeldOutRigidity(adjusted, start.adjust);
  StageReport report = DescribeCalibration(kind, calibration, limits);
  report.warnings.insert(report.warnings.begin(), start.warnings.begin(), start.warnings.end());
  return {std::move(calibration), std::move(report)};
}

}  // namespace articap
