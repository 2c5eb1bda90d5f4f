// SPDX-License-Identifier: MIT
#include "calib/mirror_rays.h"

#include <Eigen/Cholesky>

namespace articap {

std::optional<Eigen::Vector3d> PlaceDot(const RayPair& rays, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d reflected = rays.direct - 2 * normal.dot(rays.direct) * normal;
  Eigen::Matrix<double, 3, 2> system;
  system << rays.mirrored, -reflected;
  const Eigen::Vector2d depths =
      (system.transpose() * system).ldlt().solve(system.transpose() * (2 * normal));
  if (!(depths.minCoeff() > 0) || !(depths(1) * normal.dot(rays.direct) < 1)) return std::nullopt;
  return depths(1) * rays.direct;
}

}  // namespace articap
