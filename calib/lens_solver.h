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

// One camera before it is adjusted with others, or with mirrors.
struct StartingLens {
  Camera camera;
  LensModel model = LensModel::kPinhole;
  LensFreedom freedom;  // none where the lens is held
  LeftOutSightings set_aside;
  std::vector<std::string> warnings;
};

// The lens that is known, where it is to be held, else the full model: what the views do not
// support is left out in the end, by all of them (calib/lens_model.h).
Result<StartingLens> StartLens(const BoardSpec& board, const CameraSightings& camera,
                               const LensOptions& options, bool hold_known_lens);

}  // namespace articap
