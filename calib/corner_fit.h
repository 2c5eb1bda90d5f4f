// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "calib/gray_picture.h"

namespace articap {

// The pixels that a corner is fitted to, around where it is expected. Its edges and neighbours are
// taken from `px_from_squares`, which leads from board coordinates in squares (x along the rows)
// to the picture: its columns are the steps to the next corners.
struct CornerWindow {
  Eigen::Matrix2d px_from_squares = Eigen::Matrix2d::Identity();
  // How far the window reaches along rows and columns, squares.
  double reach = 0.5;
  // Pixels further than this from both edges are left out, squares: where markers are printed.
  double arm = std::numeric_limits<double>::infinity();
  // If above 0: a square window of this half side instead, px.
  double half_side_px = 0;
};

// What a fit found at a corner.
struct CornerFit {
  Eigen::Vector2d point_px = Eigen::Vector2d::Zero();
  double sigma_px = 0;  // standard deviation of the point, its larger axis, from the residuals
  double blur_px = 0;   // SD of the Gaussian that the edges are blurred by, pixels included
  double level = 0;     // brightness halfway between the dark and the white squares
  // Half the difference of brightness; positive where the square above and to the left of the
  // corner is the brighter one.
  double amplitude = 0;
};

// Fits the picture of a corner, two crossing edges under blur:
//   I(r) = a + b.r + (c + d.r) erf(e1 / (sqrt(2) s)) erf(e2 / (sqrt(2) s)),
//   e = n.r + k (t.r)^2,
// with r from the corner; s includes the 1/12 px2 of the pixels' squares; each edge has a normal n,
// a tangent t and a curvature 2k, which a lens gives it; b and d are the light's gradient. Least
// squares over the pixels of the window: under white noise no unbiased estimate is better, and as
// both sides are symmetric about the corner, the shape of the blur and the response of the sensor
// hardly matter. Nothing where there is no such corner within a quarter of a square of where it is
// expected.
std::optional<CornerFit> FitCorner(const GrayPicture& picture, const Eigen::Vector2d& expected_px,
                                   const CornerWindow& window);

}  // namespace articap
