// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/text_grid.h"

namespace articap {

// Praat's long text form, UTF-8; times to the microsecond. Interval tiers only, without gaps.
std::string WriteTextGrid(const TextGrid& grid);

}  // namespace articap
