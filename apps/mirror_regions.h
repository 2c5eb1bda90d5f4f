// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "tracking/reconstruct.h"

namespace articap {

// Regions of the views of one camera before one mirror, as SetViewRegions() takes them, where
// nobody drew any: to either side of the band that the dots leave free between the face and its
// reflection, both with the band, so that a dot within it may be either's. None where there is no
// such band, or where dots to its sides do not meet as a face and its reflection do.
std::vector<std::string> RegionsByDots(const CameraArray& array, const DotVideo& video,
                                       const ReconstructOptions& options);

}  // namespace articap
