// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

namespace articap {

// Two rays of a camera to one point, z = 1: directly, and by a plane mirror.
struct RayPair {
  Eigen::Vector3d direct;
  Eigen::Vector3d mirrored;
};

// How far, px, a pair is from lying in one plane with the mirror's normal, as a point, its
// reflection and the normal do: Sampson's distance.
template <class T>
T SampsonDistance_px(const Eigen::Matrix<T, 3, 1>& direct, const Eigen::Matrix<T, 3, 1>& mirrored,
                     const Eigen::Matrix<T, 3, 1>& normal, const T& focal_px) {
  using std::sqrt;
  const T coplanar = normal.dot(direct.cross(mirrored));
  const Eigen::Matrix<T, 3, 1> by_direct = mirrored.cross(normal);
  const Eigen::Matrix<T, 3, 1> by_mirrored = normal.cross(direct);
  return focal_px * coplanar /
         sqrt(by_direct.template head<2>().squaredNorm() +
              by_mirrored.template head<2>().squaredNorm());
}

inline double SampsonDistance_px(const RayPair& rays, const Eigen::Vector3d& normal,
                                 double focal_px) {
  return SampsonDistance_px<double>(rays.direct, rays.mirrored, normal, focal_px);
}

// Where a dot is for a mirror at distance 1 from the camera: along its ray, so that its reflection
// lies on the other. Nothing where it would be behind the camera or the mirror.
std::optional<Eigen::Vector3d> PlaceDot(const RayPair& rays, const Eigen::Vector3d& normal);

}  // namespace articap
