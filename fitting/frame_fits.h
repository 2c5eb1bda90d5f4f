// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/parameter_track.h"
#include "core/tracks.h"
#include "fitting/determination.h"
#include "fitting/fit.h"
#include "fitting/shape_solver.h"

namespace articap {

// What all frames of a fit share.
struct FrameFitSetup {
  const VirtualMarkerEvaluator& evaluator;
  const Determination& determination;
  Eigen::VectorXd reference;     // where undetermined parameters are held
  Eigen::VectorXd lower, upper;  // infinite where unbounded
  std::vector<bool> determined;  // by all markers of the set together
  MarkerLoss loss;
  FitSolver solver = FitSolver::kFast;
  int threads = 0;
};

// The outcome, frame by frame; rows are frames.
struct FrameFits {
  Eigen::MatrixXd parameters;       // NaN where there is no fit
  Eigen::MatrixXd unit_sigmas;      // sigma per mm of marker sigma; infinite where held
  Eigen::MatrixXd positions_mm;     // 3 x markers numbers a frame: q(y), mm of the rig
  std::vector<FitStatus> statuses;  // never kNoHeadPose, which markers alone do not tell
  std::int64_t evaluations = 0;
};

// Fits every frame of the measured markers, in runs of frames that warm-start one another. The cut
// into runs is fixed, so that the result does not depend on the number of threads.
FrameFits FitFrames(const RigTracks& measured, const FrameFitSetup& setup,
                    const std::function<void(double part)>& progress);

// Virtual markers and unit sigmas of frames whose parameters are set already.
void EvaluateFits(const RigTracks& measured, const FrameFitSetup& setup, FrameFits* fits);

}  // namespace articap
