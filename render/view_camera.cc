// SPDX-License-Identifier: MIT
#include "render/view_camera.h"

#include <Eigen/Geometry>

#include "core/check.h"

namespace articap {
namespace {

Eigen::Matrix3d CameraFromScene(const LookAt& look_at) {
  const Eigen::Vector3d ahead = (look_at.target_mm - look_at.eye_mm).normalized();
  const Eigen::Vector3d right = ahead.cross(look_at.up).normalized();
  Eigen::Matrix3d camera_from_scene;
  camera_from_scene.row(0) = right.transpose();
  camera_from_scene.row(1) = ahead.cross(right).transpose();
  camera_from_scene.row(2) = ahead.transpose();
  ARTICAP_CHECK(camera_from_scene.allFinite());
  return camera_from_scene;
}

Eigen::Vector2d PictureCenter(int width, int height) {
  return {0.5 * (width - 1), 0.5 * (height - 1)};
}

}  // namespace

PinholeView::PinholeView(const LookAt& look_at, double height_mm, int width, int height)
    : width_(width),
      height_(height),
      focal_px_(height * (look_at.target_mm - look_at.eye_mm).norm() / height_mm),
      eye_mm_(look_at.eye_mm),
      camera_from_scene_(CameraFromScene(look_at)) {
  ARTICAP_CHECK_GT(height_mm, 0);
}

std::optional<SightRay> PinholeView::RayThrough(const Eigen::Vector2d& point_px) const {
  Eigen::Vector3d direction_in_camera;
  direction_in_camera << point_px - PictureCenter(width_, height_), focal_px_;
  return SightRay{eye_mm_, camera_from_scene_.transpose() * direction_in_camera.normalized()};
}

Eigen::Vector2d PinholeView::Project(const Eigen::Vector3d& point_mm) const {
  const Eigen::Vector3d point_in_camera = camera_from_scene_ * (point_mm - eye_mm_);
  return PictureCenter(width_, height_) +
         focal_px_ * point_in_camera.head<2>() / point_in_camera.z();
}

OrthographicView::OrthographicView(const LookAt& look_at, double height_mm, int width, int height)
    : width_(width),
      height_(height),
      pixel_mm_(height_mm / height),
      eye_mm_(look_at.eye_mm),
      camera_from_scene_(CameraFromScene(look_at)) {
  ARTICAP_CHECK_GT(height_mm, 0);
}

std::optional<SightRay> OrthographicView::RayThrough(const Eigen::Vector2d& point_px) const {
  Eigen::Vector3d origin_in_camera;
  origin_in_camera << pixel_mm_ * (point_px - PictureCenter(width_, height_)), 0;
  return SightRay{eye_mm_ + camera_from_scene_.transpose() * origin_in_camera,
                  camera_from_scene_.row(2).transpose()};
}

Eigen::Vector2d OrthographicView::Project(const Eigen::Vector3d& point_mm) const {
  const Eigen::Vector3d point_in_camera = camera_from_scene_ * (point_mm - eye_mm_);
  return PictureCenter(width_, height_) + point_in_camera.head<2>() / pixel_mm_;
}

}  // namespace articap
