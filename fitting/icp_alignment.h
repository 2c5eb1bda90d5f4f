// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/result.h"
#include "core/transforms.h"
#include "fitting/cloud_refinement.h"
#include "rig/face_rig.h"

namespace articap {

struct IcpOptions {
  // Rotations rig_from_cloud to search around; each is tried with turns of up to some 35 degrees
  // about all three axes.
  std::vector<Eigen::Quaterniond> starts = {Eigen::Quaterniond::Identity()};
  CloudModel model;
  // Let markers be drawn to the rig's landmarks, where most set-ups place them, as well as to its
  // skin, which alone says little about where along a smooth cheek a marker sits.
  bool use_landmarks = true;
};

struct IcpAlignment {
  Sim3d rig_from_cloud;
  std::vector<double> distances_mm;  // of every point to the rig's skin, mm of the rig
  double median_distance_mm = 0;
  double cost = 0;  // CloudFit's
  // The best cost of an alignment turned by more than 20 degrees against this one; where it is not
  // much larger, the cloud does not tell how the head is turned. Infinite where all starts agree.
  double runner_up_cost = 0;
  int num_starts = 0;
};

// The fewest points that an alignment with seven unknowns is tried with.
constexpr int kLeastCloudPoints = 10;

// Lays a cloud of unnamed markers on a rig's face: PCL's iterative closest points (Besl and McKay
// 1992) from many starts, then the similarity that RefineCloudAlignment finds from the best of
// them. Every point must be finite. Fails for fewer than kLeastCloudPoints points, for a cloud of
// an impossible size, and in builds without PCL.
Result<IcpAlignment> AlignCloudToRig(std::span<const Eigen::Vector3d> cloud_mm, const FaceRig& rig,
                                     const IcpOptions& options = {});

}  // namespace articap
