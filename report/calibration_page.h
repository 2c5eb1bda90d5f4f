// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace articap {

// What CalibrationJson() (calib/calibration_json.h) says, as one HTML page that needs no network:
// the verdict in words, coverage, residuals, views, lenses, and where cameras, mirrors and boards
// stood. The same JSON gives the same bytes.
std::string CalibrationPage(const std::string& calibration_json);

}  // namespace articap
