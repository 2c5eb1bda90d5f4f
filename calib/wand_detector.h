// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "calib/wand_calibration.h"
#include "core/frame_source.h"
#include "core/image.h"
#include "core/options.h"
#include "core/result.h"

namespace articap {

struct SpotOptions {
  // What belongs to a marker: this part of the way from the background to the brightest, 0 to 1.
  double threshold = 0.5;
  double min_diameter_px = 3;
  double max_diameter_px = 80;
  double min_roundness = 0.6;  // of the two widths, the smaller over the larger
};
void VisitOptions(SpotOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const SpotOptions& options);

// Centres of round bright spots on a dark background, in the picture's coordinates: centroids of
// the light above the background, each pixel weighted by its 1.5th power.
std::vector<Eigen::Vector2d> FindSpots(const ImageView& image,
                                       const PictureFromImage& picture_from_image,
                                       const SpotOptions& options);

// The spots of every frame of a video.
Result<WandVideo> FindWand(FrameSource& source, const SpotOptions& options,
                           const std::function<void(double part)>& progress = {});

}  // namespace articap
