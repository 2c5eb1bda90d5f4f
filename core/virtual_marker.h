// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>

namespace articap {

// A point tied to a rig's surface (Beskow): q = v1 + s (v2 - v1) + t (v3 - v1) + u e1, with e1 the
// area-weighted unit vertex normal at v1, s and t without unit, u in mm of the rig.
struct VirtualMarker {
  std::string name;
  Eigen::Vector3i triangle = Eigen::Vector3i::Zero();  // vertices v1, v2, v3 of the rig
  double s = 0;
  double t = 0;
  double u_mm = 0;
};

}  // namespace articap
