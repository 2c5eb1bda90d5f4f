// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "calib/network.h"
#include "core/camera.h"

namespace articap {

// A picture of the wand within a network, its markers in the order of the instant's ends.
struct WandSighting {
  int camera = 0;
  int instant = 0;
  double time_s = 0;  // by its camera's clock
  std::array<Eigen::Vector2d, 2> ends_px;
};

// Where the wand was. The same end is first all the time.
struct WandInstant {
  double time_s = 0;  // on the clock of the array
  std::array<Eigen::Vector3d, 2> ends_mm;
};

// Cameras that saw a wand in many places.
struct WandNetwork {
  CameraArray array;
  std::vector<WandInstant> instants;
  std::vector<WandSighting> sightings;
  double length_mm = 0;
  // How far it may be off: all the time alike, and from one instant to the next.
  double length_sigma_mm = 0;
  // Of one coordinate of a marker in a view of the usual noise, to weigh pixels against the length.
  double sigma_px = 0.1;
};

struct AdjustedWand {
  WandNetwork network;
  bool converged = false;
  // Standard deviation of one coordinate of a marker, without outliers (HuberSums): of all cameras
  // together, and of each (calib/view_noise.h).
  double sigma_px = 0;
  std::vector<double> noise_px;
  std::vector<CameraParameter> parameters;
  Eigen::MatrixXd covariance;
  // seen - expected, px; the two ends of each sighting.
  std::vector<std::array<Eigen::Vector2d, 2>> residuals_px;
};

// Bundle adjustment of the cameras and of the wand's ends, whose distance is known.
AdjustedWand AdjustWand(const WandNetwork& network, const AdjustOptions& options);

std::vector<double> InstantTimes_s(const WandNetwork& network);

// How the ends move about an instant, by the instants next to it; `times_s` of all of them.
std::array<Eigen::Vector3d, 2> EndsAfter(const WandNetwork& network,
                                         const std::vector<double>& times_s, int instant,
                                         double after_s);

}  // namespace articap
