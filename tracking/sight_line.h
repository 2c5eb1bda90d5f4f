// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/camera.h"
#include "core/dots.h"

namespace articap {

// The cameras of an array as projections that a point of the stage goes through: through a mirror,
// the reflection is part of it.
//   p_in_cam = rotation * p_in_stage + translation_mm
// `rotation` is improper for mirrors.
struct ViewProjection {
  View view;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_mm;
  Eigen::Vector3d eye_in_stage_mm;  // where the rays meet: through a mirror, behind it
};
ViewProjection ProjectionOf(const CameraArray& array, const View& view);

// One dot as one view sees it, made ready for triangulation: to first order around the dot, the
// distance in pixels, whitened, between it and the image of a point of the stage is
//   r = whitening * (hnormalized(rotation * p + translation_mm) - direction)
// where the second order is that of the residual, far below a hundredth of a pixel. Glass of a
// second-surface mirror is regarded, with the angle of incidence of the dot's own ray.
struct SightLine {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation_mm;
  Eigen::Vector2d direction;    // of the plane Z = 1 of the camera, without distortion
  Eigen::Matrix2d px_of_plane;  // pixels a unit of that plane, at the dot
  Eigen::Matrix2d whitening;    // squared: inverse of the dot's covariance, through px_of_plane
  Eigen::Vector3d eye_in_stage_mm;
  Eigen::Vector3d ray_in_stage;  // unit

  // Whitened residual; nothing for points that are not ahead of the camera.
  std::optional<Eigen::Vector2d> Residual(const Eigen::Vector3d& point_in_stage_mm) const;
  // In pixels.
  std::optional<Eigen::Vector2d> Residual_px(const Eigen::Vector3d& point_in_stage_mm) const;
};

// `slack_px` is added, squared, to the variance of the centre: what calibration may be off. Nothing
// where the lens shows nothing there.
std::optional<SightLine> SightLineOf(const CameraArray& array, const ViewProjection& projection,
                                     const Dot& dot, double slack_px);

// Where two rays come nearest to one another, and how near.
struct RayMeeting {
  Eigen::Vector3d middle_mm;
  double apart_mm = 0;
  double along_first_mm = 0;  // from the eye; negative behind it
  double along_second_mm = 0;
};
// Nothing for parallel rays.
std::optional<RayMeeting> MeetingOf(const SightLine& first, const SightLine& second);

struct SightedPoint {
  Eigen::Vector3d point_in_stage_mm;
  Eigen::Matrix3d covariance_mm2;
  double chi2 = 0;  // sum of squared whitened residuals: 2 n - 3 degrees of freedom
};
// The point of greatest likelihood, by Gauss and Newton's method on all sights' residuals. Nothing
// from fewer than two, from rays that are as good as parallel, or for a point behind a camera.
// R. Hartley, P. Sturm, "Triangulation", CVIU 68(2), 1997.
std::optional<SightedPoint> PointOf(std::span<const SightLine* const> lines);

}  // namespace articap
