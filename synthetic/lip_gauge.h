// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

#include "rig/face_rig.h"
#include "rig/virtual_marker_evaluator.h"

namespace articap {

// Measures how far the lips of a rig are apart, and opens or closes them.
class LipGauge {
 public:
  // Nothing for rigs without the regions upper_lip and lower_lip.
  static std::optional<LipGauge> Create(const FaceRig& rig);

  // Height of the gap between the middles of the lips beyond that of the neutral pose, mm; negative
  // where the lips would have to cross.
  double OpeningMm(const Eigen::VectorXd& parameters) const;

  // Moves lower_lip_depression, and where that is not enough jaw_rotation, within their ranges
  // until the opening is as wanted, or as near to it as they go.
  void SetOpening(double opening_mm, Eigen::VectorXd* parameters) const;

 private:
  LipGauge(const FaceRig& rig, const VirtualMarker& upper, const VirtualMarker& lower);
  // Bisection on one parameter, in which the opening grows, between `low` and `high`.
  void SetOpeningBy(int parameter, double low, double high, double opening_mm,
                    Eigen::VectorXd* parameters) const;

  VirtualMarkerEvaluator evaluator_;
  std::vector<RigParameter> ranges_;
  std::optional<int> lower_lip_;
  std::optional<int> jaw_;
  double neutral_gap_mm_ = 0;
};

}  // namespace articap
