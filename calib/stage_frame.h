// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calib/calibration.h"
#include "core/result.h"

namespace articap {

// Moves an array to another stage frame: cameras, mirrors, and the standard deviations of the
// cameras' translations and the mirrors' distances, which depend on where the origin is. They stay
// relative to the first camera. `covariance` is that of `parameters`, in the frame of the
// adjustment, and stays there: an array is moved once.
void MoveStage(const std::vector<CameraParameter>& parameters, const Eigen::MatrixXd& covariance,
               const Rigid3d& new_from_old, CameraArray& array);

// The same for a whole calibration, its placements included.
void MoveStage(const Rigid3d& new_from_old, Calibration& calibration);

// The frame of a camera of that name: x to the right of its picture, y down, z ahead.
Result<Rigid3d> StageOfCamera(const CameraArray& array, const std::string& name);

// The frame of the board as it was in a picture, e.g. lying on the table: origin at its first
// corner, x along its rows, y up its columns, z out of it, towards who looks at it.
Result<Rigid3d> StageOfBoard(const Calibration& calibration, const std::string& source);

// An L-frame: three markers, one at the corner, one at the end of either arm.
struct LFrame {
  double long_mm = 0;   // from the corner to the end of the long arm, which is x
  double short_mm = 0;  // to the end of the short arm, which is y
};
struct LFrameStage {
  Rigid3d new_from_old;
  double long_found_mm = 0;
  double short_found_mm = 0;
  double angle_found_rad = 0;  // between the arms; a right one where all is well
  double rms_px = 0;
};
// The frame of an L-frame that lies still: origin at its corner, x along the long arm, y in its
// plane, z such that the frame is right-handed. `points_px` are the markers that each camera shows,
// three, in any order. Refused where they make no L of these lengths (within 5 %).
Result<LFrameStage> StageOfLFrame(const CameraArray& array,
                                  const std::vector<std::vector<Eigen::Vector2d>>& points_px,
                                  const LFrame& frame);

}  // namespace articap
