// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/transforms.h"
#include "fitting/cloud_refinement.h"
#include "fitting/face_surface.h"
#include "rig/face_rig.h"

namespace articap {

// The landmark of a point of a cloud; `landmark` is empty where there is none in reach.
struct AssignedLandmark {
  std::string landmark;
  double distance_mm = 0;
};

// The nearest pair of point and landmark first, each only once, none farther apart than reach_mm.
// Landmarks of spectacles count where three of them find a point: else nobody wears any, and a
// marker on the bridge of the nose is just that.
std::vector<AssignedLandmark> AssignLandmarks(const FaceSurface& surface,
                                              std::span<const Eigen::Vector3d> points_in_rig,
                                              double reach_mm);

// A rig whose identity was fitted to a cloud of unnamed markers, and the cloud's place on it.
struct AdaptedRig {
  FaceRig rig;
  FaceSurface surface;
  CloudFit fit;
};

// From an alignment with the rig as it is: takes turns at assigning landmarks, fitting the identity
// sliders to those pairs, and refining the alignment with the rig that results, landmarks reaching
// less far every time. On real faces a mouth may lie 15 mm from that of the average head, so
// that this is tried from places above and below, too; the fit of least cost wins.
Result<AdaptedRig> AdaptIdentity(const FaceRig& rig, std::span<const Eigen::Vector3d> cloud_mm,
                                 const Sim3d& rig_from_cloud, const CloudModel& model);

}  // namespace articap
