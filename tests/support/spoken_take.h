// SPDX-License-Identifier: MIT
#pragma once

#include "core/tracks.h"
#include "rig/face_rig.h"
#include "synthetic/speaker.h"

namespace articap {

const FaceRig& DefaultHead();

// A synthetic speaker of the default head with the map spectacles30, recorded with noise, and the
// markers in the true head frame.
struct SpokenTake {
  SyntheticTake take;
  HeadTracks tracks;
};

struct SpokenTakeOptions {
  int seed = 1;
  int num_sentences = 2;
  double noise_mm = 0.2;
  bool own_identity = true;  // a shape of the speaker's own, or that of the default head
};

SpokenTake MakeSpokenTake(const SpokenTakeOptions& options);

}  // namespace articap
