// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/tracks.h"
#include "tracking/frame_aligner.h"

namespace articap {

// References whose names are exchanged in some frames, as tracking does when markers pass near one
// another: pairs that, exchanged, fit the shape to `fit_mm` RMS where they did not. At most 200 of
// the `suspects` (frames with several outliers) are looked at. A sentence for each pair.
std::vector<std::string> FindExchangesInFrames(const StageTracks& tracks,
                                               const ReferenceModel& model,
                                               std::span<const int> suspects, double fit_mm);

}  // namespace articap
