// SPDX-License-Identifier: MIT
#pragma once

#include <ceres/autodiff_cost_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "core/camera.h"

namespace articap {

// How what is adjusted lies in memory.
//   lens       fx, fy / fx, cx, cy, then k1 k2 p1 p2 k3 k4 k5 k6
//   pose       x y z w of the rotation, translation in mm
//   mirror     the foot of the perpendicular from the camera's centre to the plane, camera frame,
//   mm offset     s, to be added to the camera's times
inline constexpr int kLensSize = 4 + Lens::kNumDistortion;
inline constexpr int kPoseSize = 7;
inline constexpr int kMirrorSize = 3;

template <class T>
using Point3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Point2 = Eigen::Matrix<T, 2, 1>;

template <class T>
Point3<T> Transform(const T* pose, const Point3<T>& point) {
  const Eigen::Map<const Eigen::Quaternion<T>> rotation(pose);
  return rotation * point + Eigen::Map<const Point3<T>>(pose + 4);
}

// False where the point is not ahead of the camera.
template <class T>
bool ProjectInto(const T* lens, const Point3<T>& point_in_cam, Point2<T>& point_px) {
  if (!(point_in_cam.z() > 1e-6)) return false;
  const Point2<T> plane = point_in_cam.template head<2>() / point_in_cam.z();
  const Point2<T> distorted = Distort(lens + 4, plane);
  point_px = {lens[0] * distorted.x() + lens[2], lens[0] * lens[1] * distorted.y() + lens[3]};
  return true;
}

// Reflects a point of the camera frame in a mirror. With glass before the plane, where the
// reflection seems to lie depends, weakly, on the angle under which it is seen.
template <class T>
Point3<T> ReflectInCamera(const T* mirror, double glass_mm, double glass_index,
                          const Point3<T>& point_in_cam) {
  const Eigen::Map<const Point3<T>> foot(mirror);
  const T distance = foot.norm();
  const Point3<T> normal = foot / distance;
  const Point3<T> reflected = point_in_cam - 2.0 * (normal.dot(point_in_cam) - distance) * normal;
  if (glass_mm == 0) return reflected;
  Point3<T> seen = reflected;
  for (int round = 0; round < 4; ++round) {
    const T cos_incidence = normal.dot(seen) / seen.norm();
    seen = reflected - 2.0 * ApparentShift(cos_incidence, glass_mm, glass_index) * normal;
  }
  return seen;
}

// A point that moves, about the instant for which it is adjusted: to the second order in time.
struct PointMotion {
  Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mm_s2 = Eigen::Vector3d::Zero();
  double shift_s = 0;  // the picture's time, by its own camera's clock, less that instant

  template <class T>
  Point3<T> After(const T& offset_s) const {
    const T time = offset_s + shift_s;
    return velocity_mm_s.cast<T>() * time + acceleration_mm_s2.cast<T>() * (0.5 * time * time);
  }
};

// Of three instants that follow one another, hold this one and span the least time, the middle one;
// nothing where there are fewer than three. Times ascend.
std::optional<int> MiddleOfTriple(const std::vector<double>& times_s, int instant);

struct TimedPoint {
  double time_s = 0;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
};

// The motion, at a time, along the parabola through three points.
inline PointMotion MotionThrough(const std::array<TimedPoint, 3>& path, double time_s) {
  const auto slope = [&](int i) -> Eigen::Vector3d {
    return (path[i + 1].point_mm - path[i].point_mm) / (path[i + 1].time_s - path[i].time_s);
  };
  PointMotion motion;
  motion.acceleration_mm_s2 = 2 * (slope(1) - slope(0)) / (path[2].time_s - path[0].time_s);
  motion.velocity_mm_s =
      slope(0) + motion.acceleration_mm_s2 * (time_s - (path[0].time_s + path[1].time_s) / 2);
  return motion;
}

// Residuals, px: where a corner of the board should be, less where it was seen.

// Parameters: lens, cam_from_stage, stage_from_board.
struct DirectCornerCost {
  Eigen::Vector3d corner_in_board_mm;
  Eigen::Vector2d seen_px;

  template <class T>
  bool operator()(const T* lens, const T* cam_from_stage, const T* stage_from_board,
                  T* residual) const {
    const Point3<T> in_stage = Transform<T>(stage_from_board, corner_in_board_mm.cast<T>());
    Point2<T> point;
    if (!ProjectInto<T>(lens, Transform<T>(cam_from_stage, in_stage), point)) return false;
    Eigen::Map<Point2<T>>{residual} = point - seen_px;
    return true;
  }

  ceres::CostFunction* Create() const;  // with its derivatives worked out
};

// Parameters: lens, cam_from_stage, mirror, stage_from_board.
struct MirroredCornerCost {
  Eigen::Vector3d corner_in_board_mm;
  Eigen::Vector2d seen_px;
  double glass_mm;
  double glass_index;

  template <class T>
  bool operator()(const T* lens, const T* cam_from_stage, const T* mirror,
                  const T* stage_from_board, T* residual) const {
    const Point3<T> in_stage = Transform<T>(stage_from_board, corner_in_board_mm.cast<T>());
    const Point3<T> in_cam = Transform<T>(cam_from_stage, in_stage);
    Point2<T> point;
    if (!ProjectInto<T>(lens, ReflectInCamera<T>(mirror, glass_mm, glass_index, in_cam), point))
      return false;
    Eigen::Map<Point2<T>>{residual} = point - seen_px;
    return true;
  }

  ceres::CostFunction* Create() const {
    return new ceres::AutoDiffCostFunction<MirroredCornerCost, 2, kLensSize, kPoseSize, kMirrorSize,
                                           kPoseSize>(new MirroredCornerCost(*this));
  }
};

// Parameters: lens, cam_from_stage, offset, stage_from_board. The motion is held meanwhile.
struct MovingCornerCost {
  Eigen::Vector3d corner_in_board_mm;
  Eigen::Vector2d seen_px;
  PointMotion motion;

  template <class T>
  bool operator()(const T* lens, const T* cam_from_stage, const T* offset_s,
                  const T* stage_from_board, T* residual) const {
    const Point3<T> in_stage =
        Transform<T>(stage_from_board, corner_in_board_mm.cast<T>()) + motion.After(offset_s[0]);
    Point2<T> point;
    if (!ProjectInto<T>(lens, Transform<T>(cam_from_stage, in_stage), point)) return false;
    Eigen::Map<Point2<T>>{residual} = point - seen_px;
    return true;
  }

  ceres::CostFunction* Create() const;  // with its derivatives worked out
};

// Parameters: lens, cam_from_stage, offset, both ends of a rod in the stage.
struct RodEndCost {
  int end;  // 0 or 1
  Eigen::Vector2d seen_px;
  PointMotion motion;

  template <class T>
  bool operator()(const T* lens, const T* cam_from_stage, const T* offset_s, const T* ends,
                  T* residual) const {
    const Point3<T> in_stage =
        Eigen::Map<const Point3<T>>(ends + 3 * end) + motion.After(offset_s[0]);
    Point2<T> point;
    if (!ProjectInto<T>(lens, Transform<T>(cam_from_stage, in_stage), point)) return false;
    Eigen::Map<Point2<T>>{residual} = point - seen_px;
    return true;
  }

  ceres::CostFunction* Create() const {
    return new ceres::AutoDiffCostFunction<RodEndCost, 2, kLensSize, kPoseSize, 1, 6>(
        new RodEndCost(*this));
  }
};

// Parameters: both ends of a rod of known length; the residual in standard deviations of it.
struct RodLengthCost {
  double length_mm;
  double sigma_mm;

  template <class T>
  bool operator()(const T* ends, T* residual) const {
    const Eigen::Map<const Point3<T>> a(ends), b(ends + 3);
    residual[0] = ((a - b).norm() - length_mm) / sigma_mm;
    return true;
  }

  ceres::CostFunction* Create() const {
    return new ceres::AutoDiffCostFunction<RodLengthCost, 1, 6>(new RodLengthCost(*this));
  }
};

}  // namespace articap
