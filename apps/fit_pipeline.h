// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/take.h"
#include "core/binding.h"
#include "core/marker_set.h"
#include "core/report.h"
#include "core/result.h"
#include "core/text_grid.h"
#include "fitting/bind.h"
#include "fitting/fit.h"
#include "rig/face_rig.h"
#include "tracking/stabilize.h"

namespace articap {

// The order of the stages from a take to parameters; nothing else in articap knows it.

struct PipelineOptions {
  MarkerReadOptions read;
  bool mirror = false;  // the recordings are mirrored; mirror them back
  StabilizeOptions stabilize;
  BindOptions bind;
  FitOptions fit;
};

// A take that a speaker was bound by.
struct BoundReference {
  Binding binding;
  Stabilized stabilized;
  std::vector<StageReport> reports;
};

// Reference take -> stabilised -> bound. The hashes of the sources are the caller's.
Result<BoundReference> BindTake(const Take& reference, const MarkerSet& set, const FaceRig& rig,
                                const PipelineOptions& options);

struct FitOutcome {
  std::string take_name;
  Binding binding;
  HeadPoseTrack head_pose;
  HeadShape head_shape;
  ShapeFit fit;
  std::vector<StageReport> reports;
};

// A take of a bound speaker -> stabilised by the binding's head shape -> fitted.
Result<FitOutcome> FitBoundTake(const Take& take, const Binding& binding, const FaceRig& rig,
                                const PipelineOptions& options);

// A take that holds its own reference pose: stabilised once, bound, fitted.
Result<FitOutcome> FitTakeByItself(const Take& take, const MarkerSet& set, const FaceRig& rig,
                                   const PipelineOptions& options);

// Writes the phone of every frame into the track, and into the fit's report how many have one;
// `tier` empty: the one that says phones. Fails where none has.
Result<void> LabelFrames(const TextGrid& labels, const std::string& tier, FitOutcome& outcome);

}  // namespace articap
