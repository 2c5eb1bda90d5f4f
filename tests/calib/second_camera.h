// SPDX-License-Identifier: MIT
#pragma once

#include "calib/calibration.h"
#include "calib/network.h"

namespace articap {

// What the mirror shows, taken for a second camera's picture: flipped, with six parameters of its
// own in place of the mirror's three, and the same lens, flipped as well.
Network WithFreeSecondCamera(const Calibration& mirrored);

}  // namespace articap
