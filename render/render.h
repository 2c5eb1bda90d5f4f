// SPDX-License-Identifier: MIT
#pragma once

#include "render/picture.h"
#include "render/scene.h"
#include "render/view_camera.h"

namespace articap {

struct RenderOptions {
  int samples_per_side = 4;  // a pixel averages the square of this many rays
  // Where the middles of a pixel and of its neighbours differ by less than this in linear light,
  // one sample is enough: several times as fast where much is plain, such as boards, and as exact
  // as long as nothing is thinner than two pixels. 0: all samples everywhere.
  double one_sample_below = 0;
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
