// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/marker_set.h"
#include "core/tracks.h"
#include "tracking/frame_aligner.h"

namespace articap {

// A set of references and how still the head stands when it is found from them.
struct ReferenceSet {
  std::vector<int> columns;
  // Of every marker of the tracks: 90th percentile of the distance from its median place, as it
  // would be were the marker itself no reference (jackknife: divided by one minus its leverage).
  // NaN for markers never seen.
  std::vector<double> motion_mm = {};
  // Mean of motion_mm over the stiller two thirds of the candidates: what a set is judged by. Some
  // candidates move by themselves, whatever the set.
  double stillness_mm = 0;
  // The largest of the members: near 1, an angle of the head hangs on that marker alone.
  double largest_leverage = 0;
};

struct ReferenceSearch {
  ReferenceSet chosen;
  ReferenceSet best;  // may be the chosen one
  // How rigid each chosen reference is, whatever the pose: how much its distance from a candidate
  // on another part of the head changes (10th to 90th percentile; the median over these
  // candidates). NaN where there are none.
  std::vector<double> distance_change_mm;
};

// Looks for the set of references in which the head stands stillest. Candidates are the markers
// that the map places on the skull or the nose; all markers where it says so of fewer than four.
// Sets grow from the best triples by the error they predict (rigidity from the distances,
// conditioning from `points_mm`, the place of every marker in some common frame), and shrink from
// all candidates by their motion; each is then tried on at most 200 of `frames`.
ReferenceSearch SearchReferences(const StageTracks& tracks, const MarkerSet& set,
                                 const std::vector<int>& chosen,
                                 const std::vector<Eigen::Vector3d>& points_mm,
                                 std::span<const int> frames, const AlignerOptions& options);

}  // namespace articap
