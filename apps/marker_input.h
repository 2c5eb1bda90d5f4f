// SPDX-License-Identifier: MIT
#pragma once

#include "core/marker_io.h"
#include "core/options.h"

namespace articap {

// The table [read] of every verb that reads marker files.
inline void VisitOptions(MarkerReadOptions& options, OptionVisitor& visit) {
  visit("unit", options.unit, "unit of length where the file names none: mm, cm, m, um or in");
  visit("force_unit", options.force_unit, "unit of length, whatever the file says");
  visit("rate_hz", options.rate_hz, "frames a second where the file holds neither rate nor times");
  visit("zero_is_missing", options.zero_is_missing,
        "a marker at exactly 0 0 0 of a text file was not seen");
}

}  // namespace articap
