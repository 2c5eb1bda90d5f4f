// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/head_shape.h"
#include "core/marker_set.h"
#include "core/tracks.h"
#include "core/transforms.h"

namespace articap {

// A talking, moving average face that wears the markers of maps/spectacles30.toml.
struct HeadSceneOptions {
  int num_frames = 400;
  double noise_mm = 0.2;  // of each coordinate
  double dropout = 0;     // share of samples that are missing
  double outliers = 0;    // share of samples that are `outlier_mm` off, in any direction
  double outlier_mm = 10;
  unsigned seed = 1;
};

struct HeadScene {
  MarkerSet set;
  StageTracks tracks;
  HeadShape references;                   // the truth, in the frame of the landmark table
  std::vector<Rigid3d> truth_from_stage;  // of every frame; "truth" is that frame
};

HeadScene MakeHeadScene(const HeadSceneOptions& options);

// The marker set of maps/spectacles30.toml.
MarkerSet SpectaclesSet();

// The constant transform between two frames of the head, from the references' places in both.
Rigid3d HeadFromTruth(const HeadShape& in_head, const HeadShape& in_truth);

}  // namespace articap
