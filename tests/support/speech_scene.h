// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/virtual_marker.h"
#include "rig/face_rig.h"

namespace articap {

// Noisy positions of the thirty face markers of maps/spectacles30.toml on the default head while it
// speaks, in the rig frame, with the truth: what solvers are tested and timed on.
struct SpeechScene {
  FaceRig rig;
  std::vector<VirtualMarker> markers;
  Eigen::MatrixXd truth;                               // frames x parameters
  std::vector<std::vector<Eigen::Vector3d>> measured;  // frames, then markers; mm
  Eigen::VectorXd lower, upper;                        // the rig's ranges
};

SpeechScene MakeSpeechScene(int num_sentences, double noise_mm, int seed = 1);

}  // namespace articap
