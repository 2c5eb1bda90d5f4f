// SPDX-License-Identifier: MIT
#include "synthetic/smooth_steps.h"

#include <algorithm>

#include "core/check.h"

namespace articap {

double TriweightStep(double x) {
  if (x <= -1) return 0;
  if (x >= 1) return 1;
  // With y = (1 + x) / 2, written as a polynomial without subtractions that cancel near y = 0.
  const double y = 0.5 * (1 + x);
  return y * y * y * y * (35 + y * (-84 + y * (70 - 20 * y)));
}

void SmoothSteps::Add(double end_s, double target, double weight) {
  ARTICAP_CHECK_GT(weight, 0);
  if (!segments_.empty()) ARTICAP_CHECK_GT(end_s, segments_.back().end_s);
  segments_.push_back({end_s, target, weight});
}

double SmoothSteps::At(double time_s) const {
  ARTICAP_CHECK(!segments_.empty());
  // The first segment that reaches into the kernel's support; the last one never ends.
  auto segment = std::lower_bound(
      segments_.begin(), segments_.end() - 1, time_s - half_width_s_,
      [](const Segment& candidate, double begin_s) { return candidate.end_s <= begin_s; });
  double step = 1;  // of the segment's beginning
  double weighted_targets = 0;
  double weights = 0;
  while (true) {
    const bool is_last = segment + 1 == segments_.end();
    const double end_step = is_last ? 0 : TriweightStep((time_s - segment->end_s) / half_width_s_);
    const double dominance = segment->weight * (step - end_step);
    weighted_targets += dominance * segment->target;
    weights += dominance;
    if (end_step == 0) break;
    step = end_step;
    ++segment;
  }
  return weighted_targets / weights;
}

}  // namespace articap
