// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "calib/calibration.h"
#include "calib/lens_calibration.h"
#include "core/result.h"

namespace articap {

struct SolvedLens {
  AdjustedNetwork adjusted;  // one camera; one placement a sighting that was kept
  LensModel model = LensModel::kBrown5;
  LeftOutSightings set_aside;
  std::vector<std::string> warnings;
};

// The lens alone, without figures on held-out views: what CalibrateLens() reports on and camera
// rigs start from.
Result<SolvedLens> SolveLens(const BoardSpec& board, const CameraSightings& camera,
                             const LensOptions& options);

}  // namespace articap
