// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/marker_recording.h"

namespace articap {

// What becomes of the labels of a file on the way to marker names.
struct NamedMarkers {
  std::vector<std::string> names;  // unique, not empty
  std::string subject;
};

// Trims, takes a shared subject prefix off, names the unlabelled and makes duplicates differ. What
// was changed is said in `warnings`.
NamedMarkers NameMarkers(const std::vector<std::string>& labels,
                         std::vector<std::string>& warnings);

// The labels to write for a recording: subject prefix, no control characters, at most `max_bytes`
// long (UTF-8 is cut between characters), unique. NameMarkers() of these gives labels that are
// written the same way again.
std::vector<std::string> LabelsToWrite(const MarkerRecording& recording,
                                       std::size_t max_bytes = 255);

}  // namespace articap
