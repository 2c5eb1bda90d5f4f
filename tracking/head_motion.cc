// SPDX-License-Identifier: MIT
#include "tracking/head_motion.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

namespace articap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kArm_mm = 80;      // at which turning moves a marker as far as shifting
constexpr double kWander_mm = 100;  // how far a head strays from where it sat, SD
// A pose is never known better than this: what the markers tell from frame to frame is not
// independent.
constexpr double kLeastSigma_mm = 0.3;

Matrix6d LeastCovariance() {
  return PoseEstimate::Isotropic({}, Eigen::Vector3d::Zero(), kLeastSigma_mm / kArm_mm,
                                 kLeastSigma_mm)
      .covariance;
}

// The rate of the process whose velocity is disturbed as by accelerations that last a tenth of a
// second and of which the given is about the most, three times the SD.
double RateOf_per_s(double most_per_s2, double sigma) {
  constexpr double kLasting_s = 0.1;
  const double spectral_density = most_per_s2 * most_per_s2 / 9 * 2 * kLasting_s;
  return std::cbrt(spectral_density / (4 * sigma * sigma));
}

// Of the state's place by a PoseChange, which is in the axes of the template.
Matrix6d StateByChange(const Eigen::Quaterniond& template_from_stage) {
  Matrix6d derivative = Matrix6d::Identity();
  derivative.bottomRightCorner<3, 3>() = -template_from_stage.conjugate().toRotationMatrix();
  return derivative;
}

}  // namespace

HeadMotion::HeadMotion(const Eigen::Vector3d& center_mm, const LabelOptions& options)
    : center_mm_(center_mm) {
  const double turned_rad = options.attitude_sigma_deg * std::numbers::pi / 180;
  const double most = options.head_acceleration_mm_s2;
  sigmas_ << Eigen::Vector3d::Constant(turned_rad), Eigen::Vector3d::Constant(kWander_mm);
  rates_per_s_ << Eigen::Vector3d::Constant(RateOf_per_s(most / kArm_mm, turned_rad)),
      Eigen::Vector3d::Constant(RateOf_per_s(most, kWander_mm));
}

PoseChange HeadMotion::PlaceOf(const Rigid3d& template_from_stage) const {
  const Eigen::AngleAxisd turn(template_from_stage.rotation);
  PoseChange place;
  place << turn.angle() * turn.axis(),
      template_from_stage.Inverse() * center_mm_ - usual_center_in_stage_mm_;
  return place;
}

void HeadMotion::Start(const Rigid3d& template_from_stage) {
  is_known_ = true;
  usual_center_in_stage_mm_ = template_from_stage.Inverse() * center_mm_;
  state_ = State{};
  state_.place = PlaceOf(template_from_stage);
  state_.of_place = LeastCovariance();
  state_.of_velocity = sigmas_.cwiseProduct(rates_per_s_).array().square().matrix().asDiagonal();
}

HeadMotion::State HeadMotion::After(double step_s) const {
  // The transition of place and velocity in each component, as diagonal blocks.
  const Eigen::Array<double, 6, 1> rate = rates_per_s_.array();
  const Eigen::Array<double, 6, 1> kept = (-rate * step_s).exp();
  const PoseChange place_place = kept * (1 + rate * step_s);
  const PoseChange place_velocity = kept * step_s;
  const PoseChange velocity_place = -kept * rate.square() * step_s;
  const PoseChange velocity_velocity = kept * (1 - rate * step_s);
  const auto a = place_place.asDiagonal(), b = place_velocity.asDiagonal(),
             c = velocity_place.asDiagonal(), d = velocity_velocity.asDiagonal();
  State next;
  next.place = a * state_.place + b * state_.velocity;
  next.velocity = c * state_.place + d * state_.velocity;
  // F (P - P_stationary) F' + P_stationary: the process noise is what keeps it stationary.
  const PoseChange variances = sigmas_.array().square();
  const PoseChange of_velocities = variances.array() * rate.square();
  const Matrix6d p = state_.of_place - Matrix6d(variances.asDiagonal());
  const Matrix6d v = state_.of_velocity - Matrix6d(of_velocities.asDiagonal());
  const Matrix6d& m = state_.mixed;
  const Matrix6d to_place = a * p + b * m, to_place_v = a * m.transpose() + b * v;
  const Matrix6d to_velocity = c * p + d * m, to_velocity_v = c * m.transpose() + d * v;
  next.of_place = to_place * a + to_place_v * b;
  next.of_place.diagonal() += variances;
  next.of_velocity = to_velocity * c + to_velocity_v * d;
  next.of_velocity.diagonal() += of_velocities;
  next.mixed = to_velocity * a + to_velocity_v * b;
  return next;
}

PoseEstimate HeadMotion::Predict(double step_s) const {
  const State next = After(step_s);
  const Eigen::Vector3d turn = next.place.head<3>();
  Rigid3d pose;
  if (turn.norm() > 0) pose.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  pose.translation_mm =
      center_mm_ - pose.rotation * (usual_center_in_stage_mm_ + next.place.tail<3>());
  const Matrix6d change_by_state = StateByChange(pose.rotation).transpose();  // orthogonal
  return {pose, center_mm_, change_by_state * next.of_place * change_by_state.transpose()};
}

void HeadMotion::Update(double step_s, const PoseEstimate& found) {
  State next = After(step_s);
  const Matrix6d state_by_change = StateByChange(found.template_from_stage.rotation);
  const PoseChange place = PlaceOf(found.template_from_stage);
  const Matrix6d of_place =
      state_by_change * found.covariance * state_by_change.transpose() + LeastCovariance();
  // What is learnt of the place tells of the velocity, as far as they go together.
  const Matrix6d gain = next.of_place.llt().solve(next.mixed.transpose()).transpose();
  next.velocity += gain * (place - next.place);
  next.of_velocity -= gain * (next.of_place - of_place) * gain.transpose();
  next.mixed = gain * of_place;
  next.place = place;
  next.of_place = of_place;
  state_ = next;
}

}  // namespace articap
