// SPDX-License-Identifier: MIT
#pragma once

#include "core/marker_io.h"
#include "core/options.h"

namespace articap {

// The table [read] of every verb that reads marker files.
inline void VisitOptions(MarkerReadOptions& options, OptionVisitor& visit) {
  visit("unit", options.unit, "unit of length where the file names none: mm, cm, m, um or in");
  visit("rate_hz", options.rate_hz, "frames a second where the file holds neither rate nor times");
}

}  // namespace articap
