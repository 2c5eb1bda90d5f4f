// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "calib/calibration.h"
#include "calib/lens_calibration.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

struct RigOptions {
  // Lenses that were calibrated before are adjusted along with the rest; false: they are held.
  bool adjust_lenses = true;
  // The cameras are not synchronous: each one's offset is estimated from the moving board.
  bool free_time_offsets = false;
  // Residuals above so many sigmas count less (Huber); 0: plain least squares.
  double huber_sigmas = 3;
  bool set_views_aside = true;
  // The array is not usable beyond these.
  double max_rms_px = 1;
  double max_rigidity_mm = 1;
  double max_held_focal_percent = 2;
  double max_misfit = 3;
};
void VisitOptions(RigOptions& options, OptionVisitor& visit);

// Several cameras that see a board together. Sightings of one instant have the same `frame`; with
// free time offsets it is their times that count, and the board must be seen in consecutive frames.
// The stage frame is the first camera's. Refused, by name: ambiguous boards, cameras without views,
// cameras that nothing links with the others.
Result<StageResult<Calibration>> CalibrateRig(const BoardSpec& board,
                                              const std::vector<CameraSightings>& cameras,
                                              const LensOptions& lens_options,
                                              const RigOptions& options);

}  // namespace articap
