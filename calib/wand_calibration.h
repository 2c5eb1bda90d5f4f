// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/calibration.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"
#include "core/time.h"

namespace articap {

// What looked like the wand's markers in a picture: the centres of bright blobs, px.
struct WandPicture {
  // Of separate pictures the number in the name, else the index, as seconds: one number, one
  // instant.
  SessionTime time;
  std::vector<Eigen::Vector2d> points_px;
};

// One camera's video of a wand that is waved through the volume.
struct WandVideo {
  std::string camera;
  int width = 0;
  int height = 0;
  Lens lens;  // calibrated, or roughly known
  std::vector<WandPicture> pictures;
  bool has_times = true;  // false: separate pictures, of which nobody knows when they were taken
};

struct WandOptions {
  double length_mm = 0;  // between the centres of the wand's two markers
  // How well that is known. It is taken for an error common to all instants, which is a scale of
  // the array in the cameras' sigmas, and for as much again from one instant to the next.
  double length_sigma_mm = 0.02;
  bool adjust_focal = false;      // the focal lengths are only roughly known
  bool adjust_radial = false;     // so is the radial distortion, k1 and k2
  bool free_time_offsets = true;  // the cameras are not synchronous
  double huber_sigmas = 3;
  // The array is not usable beyond these.
  double max_rms_px = 1;
  double max_wand_score = 1;
};
void VisitOptions(WandOptions& options, OptionVisitor& visit);

struct WandCalibration {
  CameraArray array;
  // Standard deviation of one coordinate of a marker: of all cameras together, and of each.
  double sigma_px = 0;
  std::vector<double> noise_px;
  double rms_px = 0;
  int instants = 0;
  // Of each instant that two cameras or more show, from their rays alone: the distance between the
  // markers.
  std::vector<double> lengths_mm;
  // 100 x standard deviation / mean of these (easyWand: Theriault et al., J. Exp. Biol. 217, 2014).
  double wand_score = 0;
  double mean_length_mm = 0;
  // Of the free parameters, in the gauge of the first camera.
  std::vector<CameraParameter> parameters;
  Eigen::MatrixXd covariance;
};

// Cameras whose lenses are known, from a wand with two markers. The stage frame is the first
// camera's. Refused, by name: cameras that hardly see the wand, or never at the same time as
// others; time offsets of separate pictures.
Result<StageResult<WandCalibration>> CalibrateWand(const std::vector<WandVideo>& videos,
                                                   const WandOptions& options);

}  // namespace articap
