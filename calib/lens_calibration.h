// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "calib/calibration.h"
#include "core/board.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

// From the simplest to the richest; each holds those before it.
enum class LensModel : std::uint8_t { kPinhole, kK1, kK1K2, kBrown4, kBrown5, kRational };

struct LensOptions {
  // The richest that is tried; what the views do not support is left out again.
  LensModel model = LensModel::kBrown5;
  bool simplify = true;                // false: the model as asked for
  bool fixed_aspect = false;           // fx = fy
  bool fixed_principal_point = false;  // in the middle of the picture
  // Residuals above so many sigmas count less (Huber); 0: plain least squares.
  double huber_sigmas = 3;
  bool set_views_aside = true;
  // A lens is not usable beyond these.
  double max_rms_px = 1;
  double max_focal_sigma_percent = 1;
};
void VisitOptions(LensOptions& options, OptionVisitor& visit);

// One camera's lens from pictures of a board; the stage frame is the camera's. Refused: no views,
// too few, all of them parallel. What the numbers are worth is said in the report.
Result<StageResult<Calibration>> CalibrateLens(const BoardSpec& board,
                                               const CameraSightings& camera,
                                               const LensOptions& options);

}  // namespace articap
