// SPDX-License-Identifier: MIT
#pragma once

#include "core/marker_recording.h"
#include "core/report.h"

namespace articap {

// What is in a recording: markers, frames, rate, duration, unit, extent; gaps, range and residual
// of each marker; events and analog channels; what reading had to repair.
StageReport DescribeRecording(const MarkerRecording& recording, const std::string& source_name);

// Median over frames of the bounding box's diagonal of the markers seen, in mm; 0 where no frame
// shows two markers.
double MedianExtentMm(const StageTracks& tracks);

}  // namespace articap
