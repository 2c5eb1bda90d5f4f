// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/binding.h"
#include "core/report.h"
#include "fitting/fit.h"
#include "fitting/frame_fits.h"
#include "fitting/smoothing.h"
#include "rig/face_rig.h"

namespace articap {

// 1 - sum |q - p|^2 / sum |p - mean p|^2 over frames and markers: the part of the markers' movement
// that the rig explains.
struct ExplainedVariance {
  std::vector<double> per_marker;
  double mouth_and_chin = 0;  // markers of the regions upper_lip, lower_lip and jaw together
  double all = 0;
  int num_frames = 0;
};

// Judged by the frames for which `judged` is true.
ExplainedVariance ExplainVariance(const ShapeFit& fit, const std::vector<bool>& judged,
                                  const std::vector<bool>& is_mouth_or_chin);

// Tables and figures of a fit: parameters, residuals per marker, statuses.
void DescribeFit(const ShapeFit& fit, const FaceRig& rig, const std::vector<bool>& determined,
                 const ExplainedVariance& explained, StageReport* report);

// Which parameters are determined and which are held, and why. `sigmas`: of each parameter were all
// of them free.
void NoteUndetermined(const FaceRig& rig, const Eigen::VectorXd& sigmas,
                      const std::vector<bool>& determined, const FitOptions& options,
                      StageReport* report);
void NoteSmoothing(const FitOptions& options, const Smoothing& smoothing, StageReport* report);

// The noise that the parameters' sigmas are reckoned with, mm of the speaker: that of the
// residuals, where they tell; else the assumed one, with a warning.
double EstimateSigma(const ShapeFit& fit, const FrameFits& fits, const FitOptions& options,
                     StageReport* report);

// The verdict: whether the parameters may be used, and why not.
void Judge(const ShapeFit& fit, const ExplainedVariance& explained, int num_determined,
           StageReport* report);

}  // namespace articap
