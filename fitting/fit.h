// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/binding.h"
#include "core/options.h"
#include "core/parameter_track.h"
#include "core/report.h"
#include "core/result.h"
#include "core/tracks.h"
#include "fitting/marker_loss.h"
#include "rig/face_rig.h"

namespace articap {

enum class FitSolver : std::uint8_t {
  kFast,   // ShapeSolver
  kCeres,  // its reference, a hundred times slower
};

struct FitOptions {
  // Distance (the paper), squared, or Huber.
  FitMetric metric = FitMetric::kDistance;
  // Smooths the distance at zero: sqrt(d^2 + epsilon^2); mm of the rig.
  double epsilon_mm = 0.001;
  // Where the Huber metric turns from squared to linear; mm of the rig.
  double huber_mm = 1;
  FitSolver solver = FitSolver::kFast;
  // Keep parameters within the rig's ranges.
  bool bounded = true;
  // Standard deviation of a marker's coordinate assumed before the fit, mm of the speaker: decides
  // which parameters the markers can determine.
  double marker_sigma_mm = 0.2;
  // A parameter whose standard deviation would exceed this part of its range is held at the
  // reference.
  double max_sigma_of_range = 0.1;
  // Weight of a prior on smooth trajectories over the whole take, 0 for none: its strength is that
  // of one marker coordinate of marker_sigma_mm resisting accelerations of one range per
  // smoothing_s^2.
  double smoothing_s = 0;
  // Samples that would need a greater acceleration of the face are taken out before the fit, and
  // reported; 0 keeps all. Speech stays below some 20; m/s^2.
  double max_acceleration_m_s2 = 25;
  // Refine each virtual marker's s, t and u over this many frames spread over the take; 0 for none.
  int refine_frames = 0;
  // Threads; 0 for one a processor. The result does not depend on it.
  int threads = 0;
};
void VisitOptions(FitOptions& options, OptionVisitor& visit);

// What a fit finds, frame by frame. The rows of the marker tracks are the take's, the markers those
// of the binding that the take has.
struct ShapeFit {
  ParameterTrack parameters;
  RigTracks measured;         // the face markers, mm of the rig
  RigTracks virtual_markers;  // q(y), mm of the rig; missing where there are no parameters
  // Frames x markers, |q - p| in mm of the speaker; NaN where missing.
  Eigen::MatrixXf residuals_mm;
};

// Frames that explained variance must not be judged by, because the binding was made from them; by
// the take's own numbers. Empty for other takes.
using BindingFrames = FrameRange;

// The shape fit: per frame, the rig's parameters y that minimise the loss of |q_i(y) - p_i| over
// the markers seen, within the rig's ranges. `rig` without the binding's identity: it is applied
// here.
Result<StageResult<ShapeFit>> Fit(const HeadTracks& tracks, const Binding& binding,
                                  const FaceRig& rig, const FitOptions& options,
                                  const BindingFrames& binding_frames = {},
                                  const std::function<void(double part)>& progress = {});

}  // namespace articap
