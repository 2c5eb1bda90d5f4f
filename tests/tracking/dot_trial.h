// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tests/tracking/dot_picture.h"
#include "tracking/dot_detector.h"

namespace articap {

// Many dots of one kind at all places within their pixels, in pictures of a hundred dots each.
struct DotTrial {
  PaintedDot dot;  // its middle does not matter
  double background = 0.2;
  Eigen::Vector2d slope_per_px = Eigen::Vector2d::Zero();  // in each dot's own part of the picture
  PaintSensor sensor;
  DotDetectorOptions options;
  int count = 1000;
  bool turns = false;  // each dot by another angle
};

// What detection makes of them.
struct DotTrialResult {
  int missed = 0;
  int extra = 0;  // that are none
  struct Sample {
    PaintedDot truth;
    Dot found;
    Eigen::Vector2d error_px = Eigen::Vector2d::Zero();
  };
  std::vector<Sample> samples;

  double rmse_px() const;  // per axis
  // Root mean square of the errors over the standard deviations that the detector states.
  double rms_over_sigma() const;
  // The largest mean error of x over dots whose middles are in the same tenth of a pixel, and of y.
  double largest_phase_bias_px() const;
  double mean_diameter_px() const;
  double mean_misfit() const;
};
DotTrialResult RunTrial(const DotTrial& trial, std::uint64_t seed);

// Root mean square of the Cramer-Rao bounds along x and y, over some places within the pixel.
double BoundOf(const DotTrial& trial);

}  // namespace articap
