// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/options.h"
#include "core/transforms.h"
#include "synthetic/utterance.h"

namespace articap {

struct SyntheticHeadMotionOptions {
  double max_rotation_deg = 15;    // total angle from the mean attitude
  double max_translation_mm = 40;  // of the neck's pivot from its mean place
  double nod_deg = 3;              // largest nod on a stressed syllable
};
void VisitOptions(SyntheticHeadMotionOptions& options, OptionVisitor& visit);

// How a speaker's head moves: slow sway in all six degrees of freedom, and nods on stressed
// syllables. The attitude of every frame as moved_from_mean, both with head axes.
std::vector<Rigid3d> SynthesizeHeadMotion(const Utterances& utterances, int num_frames,
                                          double rate_hz, const SyntheticHeadMotionOptions& options,
                                          std::uint64_t seed);

}  // namespace articap
