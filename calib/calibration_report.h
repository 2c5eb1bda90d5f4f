// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "calib/calibration.h"
#include "core/report.h"

namespace articap {

// Beyond these a calibration is not usable.
struct CalibrationLimits {
  double max_rms_px = 1;
  double max_focal_sigma_percent = 1;
  double max_rigidity_mm = 1;
  // Of a lens that was held, where the pictures contradict it by more than this.
  double max_held_focal_percent = 2;
  // Of a view's noise, over that of corners against their neighbours.
  double max_misfit = 3;
};

// What is said of every calibration: figures, the parameters with their sigmas, every view with its
// residuals, coverage; a verdict in words, and what to record again. `kind` is the stage's name,
// e.g. "calibrate lens".
StageReport DescribeCalibration(const std::string& kind, const Calibration& calibration,
                                const CalibrationLimits& limits);

// Where each camera stands in the stage frame, and how its clock differs.
ReportTable CameraTable(const CameraArray& array);

// The tables of a report that say where cameras and mirrors stand, once more in the array's own
// stage frame: for a stage that is chosen after the report was made. Also for a wand's report.
void DescribePlacesAnew(const CameraArray& array, StageReport& report);

// The part of a camera's picture, 0 to 1, in which corners were seen: of a grid of 8 x 6 fields.
struct Coverage {
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;
  std::vector<int> corners_in_field = std::vector<int>(kColumns * kRows, 0);  // row by row

  double part() const;
  // Sides and corners of the picture where nothing was seen: "the right side", ...
  std::vector<std::string> gaps() const;
};
Coverage CoverageOf(const Calibration& calibration, int camera);

}  // namespace articap
