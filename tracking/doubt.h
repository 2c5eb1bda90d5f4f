// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/tracks.h"
#include "tracking/label.h"
#include "tracking/take_review.h"

namespace articap {

enum class DoubtKind : std::uint8_t {
  kSwap,      // two markers move less if they exchange names from here on
  kMargin,    // another explanation is nearly as likely
  kResidual,  // the views disagree about where the marker is
  kFill,      // nobody saw it for long: it is filled, or a gap
};

// A place of a take at which a person should look.
struct Doubt {
  DoubtKind kind = DoubtKind::kResidual;
  int frame = 0;  // from 0, the worst of
  int first = 0;  // those from here
  int last = 0;   // to here
  int marker = 0;
  int other = -1;    // with which it may be exchanged
  double score = 1;  // 1: just worth a look; scores of different kinds are comparable
  std::string why;   // a few words with the figure
};

// Where looking begins. Each is a score of 1; what is twice as bad is 1 more.
struct DoubtLimits {
  double residual = 4;       // times the median residual of the take
  double margin = 3;         // difference of log-likelihood: one in twenty would be wrong
  double unseen_s = 0.25;    // how long nobody saw a marker
  double swap_s = 0.2;       // frames further apart are not compared for exchanged names
  double least_swap_mm = 2;  // nearer markers tell nothing by their movement
};

// All doubts of a take, those of one marker and kind in frames that nearly touch being one; the
// greatest come first. `tracks`: the take as it is written.
std::vector<Doubt> DoubtsOf(const TakeReview& review, const Labelling& labelling,
                            const StageTracks& tracks, const DoubtLimits& limits = {});

// The same doubts, those first at which a person should look who looks at `count`: spread over the
// take, which is cut into as many parts; the greatest of all parts come before the second of any.
// These, and the others after them, are in the order in which they came.
std::vector<Doubt> SpreadFirst(const std::vector<Doubt>& doubts, int count, int num_frames);

}  // namespace articap
