// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/point_cloud.h"
#include "tracking/label.h"

namespace articap {

// Points that are one and the same from frame to frame, by their places within the head alone, make
// a tracklet; the label that most of its samples carry, each weighted by its margin, becomes the
// label of all. How many samples changed.
int RepairByVotes(const PointClouds& clouds, std::vector<LabelledFrame>& frames);

}  // namespace articap
