// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/tracks.h"

namespace articap {

// A sample of a marker that was somewhere else for a moment: a reflection, a neighbour, a misread.
struct Spike {
  int frame = 0;  // counted from 0
  int marker = 0;
};

// What a face can do, and what noise adds.
struct SpikeLimits {
  // Lips and jaw stay below some 20 m/s^2 in speech; mm/s^2.
  double max_acceleration_mm_s2 = 25000;
  double noise_mm = 1.5;
};

// The samples that no face could have brought there: further from the straight line between the
// marker's neighbours in time, m frames before and n after, than
//   noise + 1/2 acceleration m n dt^2.
// Of neighbours that spoil one another's lines the worst goes first. Samples without a neighbour
// within a tenth of a second on both sides are not judged; the lower the rate, the larger a spike
// must be. By frame, then by marker.
std::vector<Spike> FindSpikes(const RigTracks& tracks, const SpikeLimits& limits);

}  // namespace articap
