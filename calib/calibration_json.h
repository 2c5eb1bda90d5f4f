// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "calib/calibration.h"
#include "calib/wand_calibration.h"
#include "core/report.h"

namespace articap {

// All that is known of a calibration as UTF-8 JSON: the keys of StageReport::ToJson(), then
// "calibration", from which report/calibration_page.h makes its page. Lengths are mm, angles rad,
// pictures px; corners and residuals are rounded to 0.001 px; null stands for what is not known.
// The same calibration gives the same bytes.
//   sigma_px, rms_px, cameras: [{name, width, height, lens, lens_sigmas, cam_from_stage,
//     time_offset_s, time_offset_sigma_s, noise_px}], mirrors: [{..., noise_px}]
// of a board's calibration also
//   board, degrees_of_freedom, held_out, placements, cameras[].coverage,
//   sightings: [{source, view, camera, mirror, placement, used, reason, rms_px, corners, points_px,
//     residuals_px}]
// and of a wand's
//   wand: {instants, mean_length_mm, score, lengths_mm}.
std::string CalibrationJson(const Calibration& calibration, const StageReport& report);
std::string CalibrationJson(const WandCalibration& calibration, const StageReport& report);

}  // namespace articap
