// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace articap {

// The value that `part` of the others lie below, 0 to 1: that of the nearest rank, none between.
// NaN of nothing. None of the values may be NaN.
double QuantileOf(std::vector<double> values, double part);
// Of an even number the upper one of the middle two.
double MedianOf(std::vector<double> values);

}  // namespace articap
