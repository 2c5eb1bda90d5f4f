// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "calib/board_finder.h"
#include "core/board.h"
#include "core/options.h"
#include "core/result.h"

namespace articap {

struct ViewChoiceOptions {
  int max_views = 40;  // more make a calibration slower, but hardly better
  // Of a video: frames in which the board moves faster are blurred by it, and of cameras that do
  // not expose together they show different places.
  double max_motion_px = 3;
  // Frames whose edges are wider than those of the sharpest tenth by this factor are not used.
  double max_blur_ratio = 2.5;
  // How far from all chosen views another one must be; 1: the width of the picture aside, or half
  // as far away, or tilted by some 45 degrees.
  double min_novelty = 0.01;
};
void VisitOptions(ViewChoiceOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const ViewChoiceOptions& options);

struct ViewChoice {
  std::vector<FoundBoard> views;    // in the order of the frames
  std::vector<SetAside> set_aside;  // the other ones, in the same order
  double covered = 0;               // part of the picture's area that corners of a view are in
};

// Picks the frames that tell a calibration most: sharp, still, all over the picture, in many
// places, distances and tilts. One after the other, each time that which is furthest from those
// chosen before and covers most of what they do not. Both sightings of a frame, directly and in a
// mirror, stay together and count as one.
ViewChoice ChooseViews(const Sightings& sightings, const BoardSpec& board,
                       const ViewChoiceOptions& options = {});

}  // namespace articap
