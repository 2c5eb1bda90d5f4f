// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "render/picture.h"
#include "render/scene.h"
#include "render/view_camera.h"

namespace articap {

// A round part of a picture.
struct PictureSpot {
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  double radius_px = 0;
};

struct RenderOptions {
  int samples_per_side = 4;  // a pixel averages the square of this many rays
  // Where what the middle of a pixel sees is less than this, in linear light, off halfway between
  // its neighbours to either side, in all four directions, one sample is enough: several times as
  // fast where much is plain, such as boards, and as exact as long as nothing is thinner than two
  // pixels. 0: all samples everywhere.
  double one_sample_below = 0;
  // With one_sample_below: of every so many pixels each way one is looked at first, and those
  // between only where these few are not as even. As exact as long as nothing is thinner than two
  // steps, spots aside.
  int step_px = 1;
  // Where small things are, such as dots: every pixel is looked at, and those on edges take more
  // samples.
  std::vector<PictureSpot> spots = {};
  int samples_per_side_in_spots = 8;
  // Only these rows of the picture are made, the last excluded; the others stay black.
  int first_row = 0;
  int end_row = std::numeric_limits<int>::max();
  double occlusion_mm = 60;  // nearer surfaces keep the ambient light away; 0: none do
  bool shadows = true;       // of the directional lights
  int num_threads = 2;       // the picture does not depend on it
};

// Light that arrives at each pixel (box filter). The same input gives the same bytes.
LinearPicture RenderLinear(const Scene& scene, const ViewCamera& camera,
                           const RenderOptions& options = {});

// The same as an sRGB picture.
Picture Render(const Scene& scene, const ViewCamera& camera, const RenderOptions& options = {});

}  // namespace articap
