// SPDX-License-Identifier: MIT
#pragma once

#include <random>
#include <vector>

#include "core/tracks.h"
#include "tracking/gap_windows.h"

namespace articap {

struct CutTake {
  StageTracks tracks;
  std::vector<Gap> gaps;
};

// Cuts gaps of one length into a take without gaps: one after another, at least 12 frames apart, in
// markers drawn from `markers`, `together` different ones at a time.
CutTake CutGaps(const StageTracks& whole, const std::vector<int>& markers, int length, int together,
                std::mt19937& random);

// Errors over the gaps of many cuts.
struct GapErrors {
  int gaps = 0;
  int samples = 0;
  int left = 0;  // samples that were not filled
  double linear_mm2 = 0;
  double cubic_mm2 = 0;   // Hermite, with the slopes of the last two frames on either side
  double spline_mm2 = 0;  // cubic spline through eight frames on either side
  double filled_mm2 = 0;
  int far_off = 0;           // gaps whose RMS error is more than three of their standard deviations
  double over_variance = 0;  // sum of squared errors of a coordinate over their estimated variances

  void Add(const StageTracks& whole, const std::vector<Gap>& cut, const StageTracks& filled);
  // RMS distance in mm.
  double Rms(double sum_mm2) const;
  // RMS error over the estimated one: 1 if the estimates are right.
  double NormalisedRms() const;
};

}  // namespace articap
