// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/image.h"
#include "synthetic/random.h"

namespace articap {

// An evenly coloured ellipse on an even or shaded ground, as a lens with a Gaussian blur shows it.
// Values are parts of the full range.
struct PaintedDot {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes_px = Eigen::Vector2d(5, 5);
  double angle_rad = 0;  // of the first axis from x
  double contrast = 0.6;
  double blur_px = 0.7;  // SD of the lens alone

  static PaintedDot Disc(const Eigen::Vector2d& center_px, double diameter_px);
};

// Light before the sensor.
struct LightPicture {
  int width = 0;
  int height = 0;
  std::vector<double> light;

  LightPicture(int picture_width, int picture_height, double background = 0);
  double& at(int x, int y) { return light[static_cast<std::size_t>(y) * width + x]; }
  double at(int x, int y) const { return light[static_cast<std::size_t>(y) * width + x]; }
  // Adds a plane that is 0 at the point.
  void AddSlope(const Eigen::Vector2d& per_px, const Eigen::Vector2d& zero_at_px);
  // Adds contrast times the part of each pixel that the blurred ellipse covers. Its coverage is
  // sampled 64 times a pixel down and exactly across, then filtered by the blur and the pixel's
  // square on a grid of 1/8 px: the middle is right to some 0.0001 px.
  void Add(const PaintedDot& dot);
  // Something before the picture, with a straight edge: from_px and what is to its right.
  void Cover(double from_px, double value, double blur_px);
};

struct PaintSensor {
  PixelFormat format = PixelFormat::kGray8;  // or kGray16
  double full_well_e = 10000;
  double read_noise_e = 5;
  bool srgb_tone = false;

  // Of a pixel, rounding included, where the tone is linear.
  double VarianceAt(double light) const;
};
Image TakePicture(const LightPicture& light, const PaintSensor& sensor, RandomGenerator& random);

// The Cramer-Rao bound of the middle: the inverse of the Fisher information of all the parameters
// of a dot (and of its ground, with a slope or without), by differences of the painted picture.
// Saturated pixels tell nothing.
Eigen::Matrix2d CenterBound(const PaintedDot& dot, double background, bool with_slope,
                            const PaintSensor& sensor);

}  // namespace articap
