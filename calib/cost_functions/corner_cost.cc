// SPDX-License-Identifier: MIT
#include "calib/cost_functions/corner_cost.h"

#include <ceres/sized_cost_function.h>

#include <cmath>

namespace articap {
namespace {

template <int kColumns>
using Jacobian = Eigen::Matrix<double, 2, kColumns, Eigen::RowMajor>;

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return cross;
}

// A pose with a point that it moves, and the derivatives of the moved point.
struct PosedPoint {
  PosedPoint(const double* pose, const Eigen::Vector3d& point)
      : rotation(Eigen::Map<const Eigen::Quaterniond>(pose).toRotationMatrix()),
        moved(rotation * point + Eigen::Map<const Eigen::Vector3d>(pose + 4)) {
    // q * p = p + 2 w (u x p) + 2 u x (u x p), q = (u, w).
    const Eigen::Vector3d u(pose);
    const double w = pose[3];
    by_pose.leftCols<3>() =
        -2 * w * CrossMatrix(point) + 2 * (u.dot(point) * Eigen::Matrix3d::Identity() +
                                           u * point.transpose() - 2 * point * u.transpose());
    by_pose.col(3) = 2 * u.cross(point);
    by_pose.rightCols<3>().setIdentity();
  }

  Eigen::Matrix3d rotation;  // also the derivative by the point
  Eigen::Vector3d moved;
  Eigen::Matrix<double, 3, kPoseSize> by_pose;
};

struct Projection {
  bool is_ahead = false;
  Eigen::Vector2d point_px;
  Eigen::Matrix<double, 2, 3> by_point;
  Jacobian<kLensSize> by_lens;
};

// ProjectInto() with its derivatives.
Projection ProjectWithDerivatives(const double* lens, const Eigen::Vector3d& point_in_cam) {
  Projection result;
  result.is_ahead = ProjectInto<double>(lens, point_in_cam, result.point_px);
  if (!result.is_ahead) return result;
  const double* k = lens + 4;
  const Eigen::Vector2d plane = point_in_cam.head<2>() / point_in_cam.z();
  const Eigen::Vector2d distorted{(result.point_px.x() - lens[2]) / lens[0],
                                  (result.point_px.y() - lens[3]) / (lens[0] * lens[1])};
  const Eigen::Vector2d focal{lens[0], lens[0] * lens[1]};

  Eigen::Matrix<double, 2, 3> by_ray;
  by_ray << 1, 0, -plane.x(), 0, 1, -plane.y();
  by_ray /= point_in_cam.z();
  result.by_point = focal.asDiagonal() * DistortJacobian(k, plane) * by_ray;

  const double x = plane.x(), y = plane.y(), r2 = plane.squaredNorm();
  const double below = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double radial = (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / below;
  const Eigen::Vector2d above_unit = plane * (r2 / below);  // by k1
  const Eigen::Vector2d below_unit = -radial * above_unit;  // by k4
  result.by_lens.col(0) << distorted.x(), lens[1] * distorted.y();
  result.by_lens.col(1) << 0, lens[0] * distorted.y();
  result.by_lens.middleCols<2>(2).setIdentity();
  auto by_distortion = result.by_lens.rightCols<Lens::kNumDistortion>();
  by_distortion.col(Lens::kK1) = above_unit;
  by_distortion.col(Lens::kK2) = r2 * above_unit;
  by_distortion.col(Lens::kP1) << 2 * x * y, r2 + 2 * y * y;
  by_distortion.col(Lens::kP2) << r2 + 2 * x * x, 2 * x * y;
  by_distortion.col(Lens::kK3) = r2 * r2 * above_unit;
  by_distortion.col(Lens::kK4) = below_unit;
  by_distortion.col(Lens::kK5) = r2 * below_unit;
  by_distortion.col(Lens::kK6) = r2 * r2 * below_unit;
  by_distortion = (focal.asDiagonal() * by_distortion).eval();
  return result;
}

template <int kColumns, class Derived>
void Store(double* to, const Eigen::MatrixBase<Derived>& jacobian) {
  if (to) Eigen::Map<Jacobian<kColumns>>{to} = jacobian;
}

class DirectCornerFunction final
    : public ceres::SizedCostFunction<2, kLensSize, kPoseSize, kPoseSize> {
 public:
  explicit DirectCornerFunction(const DirectCornerCost& cost) : cost_(cost) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    if (!jacobians) return cost_(blocks[0], blocks[1], blocks[2], residuals);
    const PosedPoint in_stage(blocks[2], cost_.corner_in_board_mm);
    const PosedPoint in_cam(blocks[1], in_stage.moved);
    const Projection projection = ProjectWithDerivatives(blocks[0], in_cam.moved);
    if (!projection.is_ahead) return false;
    Eigen::Map<Eigen::Vector2d>{residuals} = projection.point_px - cost_.seen_px;
    Store<kLensSize>(jacobians[0], projection.by_lens);
    Store<kPoseSize>(jacobians[1], projection.by_point * in_cam.by_pose);
    Store<kPoseSize>(jacobians[2], projection.by_point * in_cam.rotation * in_stage.by_pose);
    return true;
  }

 private:
  DirectCornerCost cost_;
};

class MovingCornerFunction final
    : public ceres::SizedCostFunction<2, kLensSize, kPoseSize, 1, kPoseSize> {
 public:
  explicit MovingCornerFunction(const MovingCornerCost& cost) : cost_(cost) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    if (!jacobians) return cost_(blocks[0], blocks[1], blocks[2], blocks[3], residuals);
    const PointMotion& motion = cost_.motion;
    const double time_s = *blocks[2] + motion.shift_s;
    const PosedPoint at_instant(blocks[3], cost_.corner_in_board_mm);
    const PosedPoint in_cam(blocks[1], at_instant.moved + motion.After(*blocks[2]));
    const Projection projection = ProjectWithDerivatives(blocks[0], in_cam.moved);
    if (!projection.is_ahead) return false;
    Eigen::Map<Eigen::Vector2d>{residuals} = projection.point_px - cost_.seen_px;
    const Eigen::Matrix<double, 2, 3> by_stage = projection.by_point * in_cam.rotation;
    Store<kLensSize>(jacobians[0], projection.by_lens);
    Store<kPoseSize>(jacobians[1], projection.by_point * in_cam.by_pose);
    if (jacobians[2])
      Eigen::Map<Eigen::Vector2d>{jacobians[2]} =
          by_stage * (motion.velocity_mm_s + time_s * motion.acceleration_mm_s2);
    Store<kPoseSize>(jacobians[3], by_stage * at_instant.by_pose);
    return true;
  }

 private:
  MovingCornerCost cost_;
};

}  // namespace

std::optional<int> MiddleOfTriple(const std::vector<double>& times_s, int instant) {
  std::optional<int> best;
  double best_s = HUGE_VAL;
  for (int middle : {instant, instant - 1, instant + 1}) {
    if (middle < 1 || middle + 1 >= static_cast<int>(times_s.size())) continue;
    const double span_s = times_s[middle + 1] - times_s[middle - 1];
    if (span_s < best_s) {
      best_s = span_s;
      best = middle;
    }
  }
  return best;
}

ceres::CostFunction* DirectCornerCost::Create() const { return new DirectCornerFunction(*this); }
ceres::CostFunction* MovingCornerCost::Create() const { return new MovingCornerFunction(*this); }

}  // namespace articap
