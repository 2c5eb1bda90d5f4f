// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "core/marker_recording.h"

namespace articap {

// The same recording with every position as seen from a marker, along the stage's axes: the marker
// itself stays at the origin. Standard deviations hold the marker's own besides, and what is
// measured beside a filled marker is filled. Frames without the marker have nothing to refer to,
// and are empty. The recording must have the marker.
MarkerRecording RelativeToMarker(const MarkerRecording& recording, std::string_view marker);

}  // namespace articap
