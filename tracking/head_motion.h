// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "tracking/label.h"
#include "tracking/pose_estimate.h"

namespace articap {

// Where a head is expected next: it goes on moving as it did, and in time it returns to where it
// usually is: upright as the template was learnt, and where it sat when it was found. Each
// component of the pose is a Gaussian process of the Matern class, 3/2, as a state of place and
// velocity, in a Kalman filter. So what the dots of a frame do not tell, such as a turn about the
// one marker that two views see, comes to rest instead of running away.
// J. Hartikainen, S. Sarkka, Kalman filtering and smoothing solutions to temporal Gaussian process
// regression models, MLSP 2010, eqs. 12 and 13.
class HeadMotion {
 public:
  HeadMotion(const Eigen::Vector3d& center_mm, const LabelOptions& options);

  bool is_known() const { return is_known_; }
  const Eigen::Vector3d& center_mm() const { return center_mm_; }

  // Found anew: known to half a millimetre or so, its velocity unknown.
  void Start(const Rigid3d& template_from_stage);
  PoseEstimate Predict(double step_s) const;
  // What the frame `step_s` later made of the prediction.
  void Update(double step_s, const PoseEstimate& found);

 private:
  // The attitude as a rotation vector, and how far the center is from where it usually is, in the
  // axes of the stage: turning does not move it.
  struct State {
    PoseChange place = PoseChange::Zero();
    PoseChange velocity = PoseChange::Zero();  // 1/s
    // Covariances; `mixed` is of the velocity (rows) and the place.
    Eigen::Matrix<double, 6, 6> of_place = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 6> of_velocity = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 6> mixed = Eigen::Matrix<double, 6, 6>::Zero();
  };
  State After(double step_s) const;
  PoseChange PlaceOf(const Rigid3d& template_from_stage) const;

  Eigen::Vector3d center_mm_;
  PoseChange sigmas_;       // of the process, about the usual pose
  PoseChange rates_per_s_;  // how fast it forgets
  bool is_known_ = false;
  Eigen::Vector3d usual_center_in_stage_mm_ = Eigen::Vector3d::Zero();
  State state_;
};

}  // namespace articap
