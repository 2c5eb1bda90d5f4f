// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>

namespace articap {

// A ray of sight in the scene's frame, mm.
struct SightRay {
  Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit length
};

// What the renderer asks of a camera: where a point of the picture looks. Lenses with distortion
// and views through mirrors are further implementations.
class ViewCamera {
 public:
  virtual ~ViewCamera() = default;

  virtual int width() const = 0;
  virtual int height() const = 0;
  // The ray through a point of the picture; (0, 0) is the centre of the top left pixel, x to the
  // right, y down. Nothing where the lens sees nothing. Called from several threads.
  virtual std::optional<SightRay> RayThrough(const Eigen::Vector2d& point_px) const = 0;
};

// Where a camera stands and looks to, in the scene's frame.
struct LookAt {
  Eigen::Vector3d eye_mm = Eigen::Vector3d(0, 0, 1000);
  Eigen::Vector3d target_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
};

// An ideal pinhole whose axis passes through the middle of the picture.
class PinholeView final : public ViewCamera {
 public:
  // height_mm: how much of the scene the picture's height shows at the target's distance.
  PinholeView(const LookAt& look_at, double height_mm, int width, int height);

  int width() const override { return width_; }
  int height() const override { return height_; }
  std::optional<SightRay> RayThrough(const Eigen::Vector2d& point_px) const override;
  // Where a point in front of the camera appears.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_mm) const;

 private:
  int width_;
  int height_;
  double focal_px_;
  Eigen::Vector3d eye_mm_;
  Eigen::Matrix3d camera_from_scene_;  // x right, y down, z ahead
};

// Parallel projection: for profiles and measured drawings.
class OrthographicView final : public ViewCamera {
 public:
  OrthographicView(const LookAt& look_at, double height_mm, int width, int height);

  int width() const override { return width_; }
  int height() const override { return height_; }
  std::optional<SightRay> RayThrough(const Eigen::Vector2d& point_px) const override;
  Eigen::Vector2d Project(const Eigen::Vector3d& point_mm) const;

 private:
  int width_;
  int height_;
  double pixel_mm_;
  Eigen::Vector3d eye_mm_;
  Eigen::Matrix3d camera_from_scene_;
};

}  // namespace articap
