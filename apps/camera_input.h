// SPDX-License-Identifier: MIT
#pragma once

#include "core/camera_io.h"
#include "core/options.h"

namespace articap {

// The table [read] of every verb that reads files of cameras.
inline void VisitOptions(CameraReadOptions& options, OptionVisitor& visit) {
  visit("unit", options.unit, "unit of length where the file names none: mm or m");
  visit("size", options.size, "size of the pictures where the file has none, as 640x480");
}

}  // namespace articap
