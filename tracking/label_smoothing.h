// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/marker_template.h"
#include "core/point_cloud.h"
#include "tracking/label.h"
#include "tracking/label_assignment.h"

namespace articap {

// Labels every frame again, each marker being expected where the nearest labelled samples before
// and after it, and the template, put it: the mean of a Gaussian process around home with a
// correlation that falls off over `memory_s`. The pose begins with what was found. Once forwards,
// once backwards, so that gaps close from both ends. How many samples have another label than
// before, or lost theirs.
// C. E. Rasmussen, C. K. I. Williams, Gaussian Processes for Machine Learning, 2006, eqs. 2.23 and
// 4.17 (Matern, 3/2).
int RelabelFromBothSides(const PointClouds& clouds, const MarkerTemplate& marker_template,
                         const LabelPriors& priors, double memory_s,
                         std::vector<LabelledFrame>& frames);

}  // namespace articap
