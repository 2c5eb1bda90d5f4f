// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/frame_source.h"
#include "core/image.h"

namespace articap {

// The brightness of a picture, whose pixels are square and whose rows are all there: what boards
// are sought in. 0 is black, 1 the brightest that the camera tells.
struct GrayPicture {
  int width = 0;
  int height = 0;
  std::vector<float> pixels;  // row by row

  float at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
  // Whether the point lies between the centres of the outermost pixels.
  bool Contains(const Eigen::Vector2d& point_px) const {
    return point_px.x() >= 0 && point_px.y() >= 0 && point_px.x() <= width - 1 &&
           point_px.y() <= height - 1;
  }
  // Between pixel centres, bilinearly; the point must be inside.
  double At(const Eigen::Vector2d& point_px) const;
};

// Width and height of the picture that an image is of.
Eigen::Vector2i PictureSize(const ImageView& image, const PictureFromImage& picture_from_image);

// Of an image in its own pixels, or resampled where these are not the picture's.
GrayPicture GrayPictureOf(const ImageView& image, const PictureFromImage& picture_from_image);

// As a mirror shows it: left and right are swapped.
GrayPicture Reversed(const GrayPicture& picture);

}  // namespace articap
