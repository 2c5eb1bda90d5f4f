// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/binding.h"
#include "core/report.h"
#include "fitting/fit.h"
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

}  // namespace articap
