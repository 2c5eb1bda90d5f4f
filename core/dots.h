// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"

namespace articap {

// A marker as one picture shows it: a round, evenly coloured spot whose edge an ellipse describes.
// All lengths are of the camera's picture (PictureFromImage has been applied), px, as the lens
// distorts them.
struct Dot {
  // The middle of the ellipse; once CorrectPerspective() has been through, where the marker's own
  // centre appears.
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  // Of the centre, from the noise of the pixels.
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  // The edge: points p with (p - center)^T shape^-1 (p - center) = 1.
  Eigen::Matrix2d shape_px2 = Eigen::Matrix2d::Identity();
  // Linear in what the file holds, 1 being its full range: of the spot above what surrounds it
  // (negative for a dark one), and of what surrounds it.
  double contrast = 0;
  double background = 0;
  // Mean square of what the fit leaves, over what the noise of the pixels explains: 1 for a dot
  // that is what it is taken for.
  double misfit = 1;
  bool saturated = false;  // part of it is as bright as the file can say
  bool occluded = false;   // part of it is hidden, or outside the picture

  // Of the disc of the same area.
  double diameter_px() const;
  // Shortest over longest axis.
  double roundness() const;
};

// What one frame of a camera shows.
struct DotPicture {
  std::int64_t index = 0;  // of the frame in its video, from 0
  SessionTime time;        // of the frame, on the camera's own clock
  std::vector<Dot> dots;
};

// A video of which the dots are left: what is tracked.
struct DotVideo {
  std::string camera;
  int width = 0;  // of the picture, px
  int height = 0;
  double rate_hz = 0;         // of frames, or fields
  bool constant_rate = true;  // false: only the frames' own times are right
  std::vector<DotPicture> pictures;
};

}  // namespace articap
