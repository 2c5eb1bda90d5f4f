// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "core/parameter_track.h"
#include "core/report.h"
#include "core/result.h"
#include "report/report_page.h"
#include "rig/face_rig.h"

namespace articap {

// The bytes of a GLB file in which the rig moves by the track over the window; by default over its
// first ten seconds. Frames without parameters hold those of the frame before, and are counted.
Result<StageResult<std::string>> AnimationOf(const ParameterTrack& track, const FaceRig& speaker,
                                             const std::optional<FrameWindow>& window);

}  // namespace articap
