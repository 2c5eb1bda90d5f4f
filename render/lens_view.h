// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "render/view_camera.h"

namespace articap {

// A camera with its lens; the scene's frame is the stage frame. Directions come from a table, which
// is made once and takes some ten milliseconds; make the view once a camera, not once a picture.
class LensView final : public ViewCamera {
 public:
  // How far, in pixels, the table may be off before a point is solved for instead.
  static constexpr double kMostTableError_px = 1e-6;

  explicit LensView(const Camera& camera);

  int width() const override { return camera_.width; }
  int height() const override { return camera_.height; }
  std::optional<SightRay> RayThrough(const Eigen::Vector2d& point_px) const override;

 private:
  // Node (i, j) of the table is at picture point kStep_px (i - kMargin, j - kMargin).
  static constexpr int kStep_px = 8;
  static constexpr int kMargin = 2;

  // Cubic interpolation between the 4 x 4 nodes around a point of the cell that begins at node
  // (column, row); `within` in [0, 1]^2.
  Eigen::Vector2d Interpolate(int column, int row, const Eigen::Vector2d& within) const;
  bool IsExactEnough(int column, int row) const;
  SightRay RayTowards(const Eigen::Vector3d& direction_in_cam) const;

  Camera camera_;
  Rigid3d stage_from_cam_;
  Eigen::Matrix3d rotation_stage_from_cam_;
  int columns_;  // of nodes
  int rows_;
  std::vector<Eigen::Vector2d> nodes_;  // of the plane Z = 1; NaN where the lens shows nothing
  std::vector<char> usable_;            // by the node that a cell begins with
};

}  // namespace articap
