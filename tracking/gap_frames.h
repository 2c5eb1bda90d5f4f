// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/tracks.h"
#include "core/transforms.h"

namespace articap {

// A frame of reference for each frame of a take that follows the head's slow movement, so that less
// is left to predict of what is fixed to it. Any will do that moves smoothly, since what is filled
// in it goes back to the stage by the same transform. It is carried by all markers; those that keep
// their distances better count for more. Movement above 3 Hz is not followed: else the frames would
// jump where a marker is hidden, and follow the very one that is to be filled. What little head
// movement is left is nearly linear, and regression deals with it. In takes too short to tell, the
// frames stand still.
std::vector<Rigid3d> FollowHead(const StageTracks& tracks);

// Frames x three columns a marker: positions in the local frames. Where a marker is missing, a
// straight line, or its nearest position; zero where it is never seen.
Eigen::MatrixXd LocalSeries(const StageTracks& tracks,
                            const std::vector<Rigid3d>& local_from_stage);

}  // namespace articap
