// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "core/text_grid.h"

namespace articap {

// A stretch of a recording, s, that is to become a take of its own.
struct Cut {
  double start_s = 0;
  double end_s = 0;
  std::string name;  // what people call it; may be empty
};

// The labelled intervals of a tier, by the times of its file. Fails on a tier of points, and where
// no interval has a label.
Result<std::vector<Cut>> CutsOfTier(const TextGridTier& tier);

// A text of lines "start end [name]": seconds with a decimal point, between blanks; the name is the
// rest of the line. Empty lines, and what follows a '#' at the start of a line, say nothing. Faults
// are named with their line: what is no number, and ends that are not later than their start.
Result<std::vector<Cut>> ParseCuts(std::string_view text, const std::string& source_name);

}  // namespace articap
