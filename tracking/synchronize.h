// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/dots.h"
#include "core/options.h"
#include "core/result.h"
#include "core/time.h"

namespace articap {

struct SynchronizeOptions {
  // From one row of a rolling shutter to the next; a frame's time is that of its middle row.
  double row_time_us = 0;
};
void VisitOptions(SynchronizeOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const SynchronizeOptions& options);

// The dots of all cameras of one instant, by camera.
using InstantDots = std::vector<std::vector<Dot>>;

struct SynchronizedDots {
  double rate_hz = 1;
  SessionTime start;
  std::vector<InstantDots> instants;
  double largest_shift_s = 0;  // that any picture was brought over
};

// Brings videos to common instants: those of the first camera's frames, or evenly spaced ones where
// its rate is not constant. `videos`: one a camera of the array, in its order; the array's time
// offsets are applied. Where a dot was not seen at the instant itself (another clock, another row
// of a rolling shutter), it is followed through the pictures around and interpolated, by a cubic
// through four of them or what there is of them; a dot that cannot be followed stays where it was,
// its covariance grown by the way that dots make in that time.
SynchronizedDots Synchronize(const CameraArray& array, const std::vector<DotVideo>& videos,
                             const SynchronizeOptions& options);

}  // namespace articap
