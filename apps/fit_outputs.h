// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "apps/fit_pipeline.h"
#include "apps/output_set.h"

namespace articap {

// A stretch of a take.
struct TimeWindow {
  double start_s = 0;
  double end_s = 0;
};

// The files of `articap fit` in a folder: parameters.csv, parameters.h5, residuals.csv,
// head_pose.csv, binding.toml, report.json, report.html and animation.glb, the latter two over the
// window, or over what they choose by themselves. The outcome gets the animation's report, and must
// live until the files are written.
Result<OutputSet> FitOutputs(FitOutcome& outcome, const FaceRig& rig,
                             const std::optional<TimeWindow>& window,
                             const std::filesystem::path& folder);

}  // namespace articap
