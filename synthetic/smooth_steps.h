// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace articap {

// Integral from -1 to x of the triweight kernel 35/32 (1 - x^2)^3: a step from 0 to 1 that takes
// from -1 to 1 and has three continuous derivatives. A polynomial, so the same on every machine.
double TriweightStep(double x);

// A sequence of targets, each held over a segment of time, blended into one smooth course:
//   f(t) = sum_i d_i(t) target_i / sum_i d_i(t),
// where the dominance d_i (Cohen and Massaro 1993) is weight_i times the segment's box smoothed
// with a triweight kernel. Neighbours thus colour one another (co-articulation), heavier targets
// are reached in full, short light ones are undershot; f stays within its targets, and equals a
// target exactly further than the kernel's half width inside of a segment.
class SmoothSteps {
 public:
  explicit SmoothSteps(double half_width_s) : half_width_s_(half_width_s) {}

  // Segments in order of time; each begins where the last one ends, the first at minus infinity.
  void Add(double end_s, double target, double weight = 1);

  double At(double time_s) const;

 private:
  struct Segment {
    double end_s;
    double target;
    double weight;
  };
  double half_width_s_;
  std::vector<Segment> segments_;
};

}  // namespace articap
