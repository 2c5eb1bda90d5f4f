// SPDX-License-Identifier: MIT
#pragma once

#include "core/marker_recording.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"
#include "core/tracks.h"

namespace articap {

struct FillOptions {
  // Longer gaps stay gaps; 0: all do. What fills a gap gets worse with its length: see
  // docs/tracking.md.
  double longest_s = 0.5;
  // The same, if it is less, for gaps at the beginning and the end of the take, which are seen from
  // one side only.
  double longest_at_end_s = 0.25;
  // Off where the recording is in a frame that is fixed to the head already.
  bool follow_head = true;
};
void VisitOptions(FillOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const FillOptions& options);

// Fills the gaps of a take. What was there stays as it was, filled samples of others included; what
// is made is SampleState::kFilled, with its standard deviation a coordinate, learnt from gaps that
// are cut in the same take (not known where the take is too short for that).
//
// The head's movement is taken out (tracking/gap_frames.h), then the shortest gaps are filled
// first, so that they serve the longer ones: by interpolation that is learnt from the take
// (tracking/gap_weights.h), and from four frames on by regression on the other markers for what
// strays from it (tracking/gap_regression.h), unless they tell nothing. The same serves a marker on
// the skin and one of spectacles, which the others of the spectacles tell as a rigid body would.
// Gaps at the ends of a take are filled if other markers can tell.
Result<StageResult<StageTracks>> FillGaps(const StageTracks& tracks,
                                          const FillOptions& options = {});
// The same of what a file holds: filled samples have a residual of 0, and no camera saw them.
Result<StageResult<MarkerRecording>> FillGaps(const MarkerRecording& recording,
                                              const FillOptions& options = {});

}  // namespace articap
