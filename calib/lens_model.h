// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "calib/calibration.h"
#include "calib/lens_calibration.h"
#include "calib/network.h"

namespace articap {

// The coefficients of a model.
LensFreedom FreedomOf(LensModel model, const LensOptions& options);

// Whether the coefficients that the model adds to the one below it are worth their number.
bool IsSupported(const AdjustedNetwork& adjusted, int camera, LensModel model);

// Leaves out what the network does not support, from each lens' richest coefficients down, and
// adjusts again. What has no support from one camera's pictures alone may have it from all of them:
// this is for the last adjustment. `adjust` is how the network was adjusted; it and `models`, one a
// camera, are changed along. Lenses that are held, and rational ones, stay.
AdjustedNetwork SimplifyLenses(AdjustedNetwork adjusted, const LensOptions& options,
                               AdjustOptions& adjust, std::vector<LensModel>& models);

// Of lenses that were held: adjusts once more with their focal lengths free.
std::vector<HeldLens> JudgeHeldLenses(const AdjustedNetwork& adjusted, AdjustOptions adjust);

}  // namespace articap
