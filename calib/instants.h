// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <vector>

#include "calib/calibration.h"

namespace articap {

// When a sighting was made: sightings of one instant show the board in one place.
struct Instant {
  int number = 0;     // from 0, in order of time
  double time_s = 0;  // on the clock of the array
};
// Sightings without an instant are not used.
using InstantTable = std::map<SightingKey, Instant>;

// Between pictures that follow one another, s; lost ones, and times that waver or are rounded, do
// not matter. 1 where there are not two.
double UsualInterval_s(std::vector<SessionTime> times);

// Sightings with the same frame number show the same instant.
InstantTable InstantsByFrame(const std::vector<CameraSightings>& cameras);

// For cameras that are not synchronous: the first camera's clock, divided into its usual intervals;
// each picture belongs to the nearest instant by its own camera's clock.
InstantTable InstantsByTime(const std::vector<std::vector<SessionTime>>& times_of_cameras);
InstantTable InstantsByTime(const std::vector<CameraSightings>& cameras);

}  // namespace articap
