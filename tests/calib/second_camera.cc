// SPDX-License-Identifier: MIT
#include "tests/calib/second_camera.h"

#include <Eigen/Geometry>

namespace articap {

Network WithFreeSecondCamera(const Calibration& mirrored) {
  Network network;
  network.board = mirrored.board;
  network.placements = mirrored.placements;
  Camera camera = mirrored.array.cameras[0];
  network.array.cameras = {camera, camera};
  Camera& second = network.array.cameras[1];
  second.lens.cx_px = camera.width - 1 - camera.lens.cx_px;
  second.lens.distortion[Lens::kP2] *= -1;
  // The reflection, and the flip that makes a rotation of it again.
  const Mirror& mirror = mirrored.array.mirrors[0];
  const Eigen::Vector3d& n = mirror.normal_in_stage;
  const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2 * n * n.transpose();
  const Eigen::Vector3d flip{-1, 1, 1};
  second.cam_from_stage = {Eigen::Quaterniond(Eigen::Matrix3d(flip.asDiagonal() * reflection)),
                           flip.cwiseProduct(2 * mirror.distance_mm * n)};
  for (const SightingResult& sighting : mirrored.sightings) {
    if (!sighting.used) continue;
    NetworkSighting seen{{sighting.view.mirror < 0 ? 0 : 1, -1},
                         sighting.placement,
                         0,
                         0,
                         sighting.corners,
                         sighting.points_px};
    if (sighting.view.mirror >= 0)
      for (Eigen::Vector2d& point : seen.points_px) point.x() = camera.width - 1 - point.x();
    network.sightings.push_back(seen);
  }
  return network;
}

}  // namespace articap
