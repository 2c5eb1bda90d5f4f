// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace articap {

struct TextGridInterval {
  double begin_s = 0;
  double end_s = 0;
  std::string label;
};

// Intervals without gaps, from the grid's beginning to its end.
struct TextGridTier {
  std::string name;
  std::vector<TextGridInterval> intervals;
};

// Praat's label file.
struct TextGrid {
  double begin_s = 0;
  double end_s = 0;
  std::vector<TextGridTier> tiers;
};

// The long text form, UTF-8; times to the microsecond.
std::string WriteTextGrid(const TextGrid& grid);

}  // namespace articap
