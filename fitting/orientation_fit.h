// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/transforms.h"
#include "fitting/marker_loss.h"

namespace articap {

// A strategic point as measured and as the rig has it.
struct PointPair {
  std::string name;
  Eigen::Vector3d point_in_head = Eigen::Vector3d::Zero();
  Eigen::Vector3d point_in_rig = Eigen::Vector3d::Zero();
};

struct OrientationFit {
  Sim3d rig_from_head;
  double objective = 0;              // the loss' sum, mm of the rig (mm^2 for the squared metric)
  std::vector<double> residuals_mm;  // of each pair, mm of the rig
  bool converged = false;
};

// Beskow's orientation fit: the seven parameters T(x) of rig_from_head that minimise the loss of
// the distances |T p_head - p_rig| summed over the strategic points; with the default loss, their
// sum. At least three pairs that are not on a line. The closed form (least squares) starts it, or
// `start`.
OrientationFit FitOrientation(std::span<const PointPair> pairs, const MarkerLoss& loss,
                              const std::optional<Sim3d>& start = std::nullopt);

}  // namespace articap
