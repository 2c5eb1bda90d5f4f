// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "fitting/fit.h"

namespace articap {

// CSV with the columns frame,time_s, then NAME_mm a marker: the distance of the measured to the
// virtual marker, mm of the speaker. Cells of missing markers are empty.
std::string WriteResidualCsv(const ShapeFit& fit);

}  // namespace articap
