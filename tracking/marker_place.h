// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace articap {

// Where a marker is, or is expected, in the frame of the template.
struct MarkerPlace {
  Eigen::Vector3d position_mm;
  Eigen::Matrix3d covariance_mm2;
};

}  // namespace articap
