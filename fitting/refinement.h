// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/tracks.h"
#include "core/virtual_marker.h"
#include "rig/face_rig.h"

namespace articap {

// Re-estimates where each marker sits on the rig, (s, t, u) on its triangle, from many frames: the
// latent markers of MoSh (Loper, Mahmood and Black 2014) for a rig whose pose in each frame is
// known. Linear least squares per marker, with distances weighted down as the fit's metric does,
// and with the binding's own coordinates as a prior of standard deviation `prior_mm`. `poses`:
// frames x parameters, of the frames listed. The refined markers no longer meet the reference pose
// exactly.
std::vector<VirtualMarker> RefineAttachments(const FaceRig& rig,
                                             const std::vector<VirtualMarker>& markers,
                                             const RigTracks& measured, std::span<const int> frames,
                                             const Eigen::MatrixXd& poses, double prior_mm);

}  // namespace articap
