// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace articap {

// Where the markers of a gap's surroundings move more than usual, what is filled is further off:
// error variance over its mean = scale (activity + floor)^exponent, with an activity of 1 on the
// average.
struct ActivityModel {
  double exponent = 0;
  double scale = 1;

  double VarianceFactor(double activity) const;
};

// By maximum likelihood of normal errors. `relative_squares`: squared errors over their mean.
// Nothing is learnt of few.
ActivityModel FitActivity(const std::vector<double>& activities,
                          const std::vector<double>& relative_squares);

}  // namespace articap
