// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "core/binding.h"
#include "core/head_shape.h"
#include "core/marker_set.h"
#include "core/options.h"
#include "core/report.h"
#include "core/result.h"
#include "core/tracks.h"
#include "fitting/marker_loss.h"
#include "rig/face_rig.h"

namespace articap {

// How a marker finds its triangle.
enum class AttachMethod : std::uint8_t {
  kLandmark,  // at its landmark, where the map names one; else the nearest of its region
  kNearest,   // the nearest of its region
};

struct BindOptions {
  // Reference frames "FIRST:LAST", both included, by the recording's own numbers; empty: proposed.
  std::string frames;
  // How many frames a proposed reference has, where there are as many.
  int num_reference_frames = 60;
  // Distance (the paper), squared or Huber: what the orientation fit minimises.
  FitMetric metric = FitMetric::kDistance;
  AttachMethod attach = AttachMethod::kNearest;
  // Fit the rig's identity sliders to the reference pose, together with the seven parameters.
  bool fit_identity = true;
  // Identity sliders given by hand, "name=value"; those given are not fitted.
  std::vector<std::string> identity;
  // The rig's parameters in the reference pose given by hand, "name=value", rad or mm; others are
  // 0.
  std::vector<std::string> pose;
  // Mean distance of the strategic points above which the binding is not usable, mm of the speaker.
  double max_orientation_residual_mm = 15;
};
void VisitOptions(BindOptions& options, OptionVisitor& visit);

// Ties one speaker's reference pose to a rig, once for all takes (Beskow): chooses and averages the
// reference frames, fits the seven parameters of rig_from_head at the strategic points, and
// attaches a virtual marker to every face marker, so that the error in the reference pose is
// exactly zero. `head_shape`: the head references in the head frame, kept in the binding for the
// other takes.
Result<StageResult<Binding>> Bind(const HeadTracks& reference, const HeadShape& head_shape,
                                  const MarkerSet& set, const FaceRig& rig,
                                  const BindOptions& options);

// Parses "FIRST:LAST" or "FRAME" and checks it against the recording.
Result<FrameRange> ParseFrameRange(const std::string& text, int first_frame, int num_frames);

// The rig with a binding's identity, and its pose in the reference pose, in the rig's own order.
// Fail where the rig lacks a slider or a parameter that the binding names.
Result<FaceRig> RigOfBinding(const Binding& binding, const FaceRig& rig);
Result<Eigen::VectorXd> ReferenceParameters(const Binding& binding, const FaceRig& rig);

}  // namespace articap
