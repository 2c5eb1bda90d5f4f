// SPDX-License-Identifier: MIT
#pragma once

#include "calib/calibration.h"
#include "calib/network.h"

namespace articap {

// The root mean square of the residuals, px, of sightings that the lens of a one-camera network was
// not made from: every third in turn is left out, the lens adjusted to the others, and only the
// board's pose fitted. NaN where there are fewer than six.
double HeldOutRms_px(const Network& network, const LensFreedom& freedom);

// The same for cameras and mirrors that see the board together: every `stride`th placement is left
// out, the rest adjusted, and of the placements left out each corner that two views or more show is
// triangulated. The distances between corners, all pairs of a placement, are compared with the
// board's. The noise of the views says what they should be. `options` as adjusted with.
HeldOut HeldOutRigidity(const AdjustedNetwork& adjusted, const AdjustOptions& options,
                        int stride = 5);

}  // namespace articap
