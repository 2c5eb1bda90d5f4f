// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/tracks.h"
#include "core/virtual_marker.h"
#include "rig/face_rig.h"

namespace articap {

// Re-estimates where each marker sits on the rig from many frames: the latent markers of MoSh
// (Loper, Mahmood and Black 2014) for a rig whose pose in each frame is known. Every triangle of
// the marker's region within `reach_mm` of where it was bound is tried, with (s, t, u) by linear
// least squares over the frames, distances weighted down as the fit's metric does; the best stays.
// So a marker finds the spot of the rig's skin that moves as the speaker's does. `poses`: frames x
// parameters of the take, of which those listed in `frames` are used; `bound`: the binding's own
// markers. The refined markers no longer meet the reference pose exactly.
std::vector<VirtualMarker> RefineAttachments(const FaceRig& rig,
                                             const std::vector<VirtualMarker>& bound,
                                             const std::vector<VirtualMarker>& current,
                                             const RigTracks& measured, std::span<const int> frames,
                                             const Eigen::MatrixXd& poses, double reach_mm);

}  // namespace articap
