// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/head_pose.h"

namespace articap {

// Cutoffs as parts of the frame rate: below, the smoother is too stiff for double precision; above,
// it leaves the poses as they are.
constexpr double kLowestPoseCutoff = 0.005;
constexpr double kHighestPoseCutoff = 0.4;

// What smoothing did to the poses of a take.
struct PoseSmoothing {
  // Of movements at these frequencies half of the amplitude remains; absent where there was nothing
  // to gain, and the poses are as they were.
  std::optional<double> position_cutoff_hz;
  std::optional<double> rotation_cutoff_hz;
  // Standard deviations of what is independent from frame to frame, in one coordinate and in one
  // angle of a pose, before.
  double position_noise_mm = 0;
  double rotation_noise_deg = 0;
};

// Smooths the poses that are known, over the whole take: minimises
//   sum_f w_f |x_f - z_f|^2 + lambda sum_f |third difference of x at f|^2
// for the place of the pivot in the stage, and for the rotation's quaternion; z is what was
// measured. That is the discrete form of the quintic smoothing spline (Whittaker 1923), of which
// lambda is chosen by generalised cross-validation (Craven and Wahba 1979), as Woltring's GCVSPL
// (1986) does for human movement: noise that is independent from frame to frame goes, movement that
// neighbouring frames confirm stays. Poses that are not known stay so, and count for nothing.
//
// Weights: relative precisions, one a frame, 0 where the pose is not known. The pivot, in the head
// frame, is where position and rotation err independently: the references' centroid. A positive
// `cutoff_hz`, within the limits above, takes the place of cross-validation. Takes with fewer than
// 30 known poses stay as they are.
PoseSmoothing SmoothPoses(std::span<const double> weights, const Eigen::Vector3d& pivot_in_head_mm,
                          double cutoff_hz, HeadPoseTrack* head_pose);

}  // namespace articap
