// SPDX-License-Identifier: MIT
#include "render/lens_view.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace articap {
namespace {

// Lagrange's cubic polynomials through -1, 0, 1 and 2.
std::array<double, 4> CubicWeights(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
          (t + 1) * t * (t - 1) / 6};
}

}  // namespace

LensView::LensView(const Camera& camera)
    : camera_(camera),
      stage_from_cam_(camera.cam_from_stage.Inverse()),
      rotation_stage_from_cam_(stage_from_cam_.rotation.toRotationMatrix()),
      columns_(camera.width / kStep_px + 2 * kMargin + 2),
      rows_(camera.height / kStep_px + 2 * kMargin + 2) {
  ARTICAP_CHECK(camera.width > 0 && camera.height > 0);
  const Eigen::Vector2d nothing =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const auto direction =
          Unproject(camera.lens, kStep_px * Eigen::Vector2d(column - kMargin, row - kMargin));
      nodes_.push_back(direction ? Eigen::Vector2d(direction->hnormalized()) : nothing);
    }
  usable_.assign(nodes_.size(), 0);
  for (int row = 1; row + 2 < rows_; ++row)
    for (int column = 1; column + 2 < columns_; ++column)
      usable_[static_cast<std::size_t>(row) * columns_ + column] = IsExactEnough(column, row);
}

// The error of cubic interpolation is largest in the middle of a cell.
bool LensView::IsExactEnough(int column, int row) const {
  const Eigen::Vector2d middle = Interpolate(column, row, {0.5, 0.5});
  if (!middle.allFinite()) return false;
  const auto seen_px = Project(camera_.lens, middle.homogeneous());
  const Eigen::Vector2d middle_px =
      kStep_px * Eigen::Vector2d(column - kMargin + 0.5, row - kMargin + 0.5);
  return seen_px && (*seen_px - middle_px).norm() <= kMostTableError_px;
}

Eigen::Vector2d LensView::Interpolate(int column, int row, const Eigen::Vector2d& within) const {
  const std::array<double, 4> across = CubicWeights(within.x());
  const std::array<double, 4> down = CubicWeights(within.y());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d* nodes =
        &nodes_[static_cast<std::size_t>(row - 1 + i) * columns_ + column - 1];
    sum += down[i] * (across[0] * nodes[0] + across[1] * nodes[1] + across[2] * nodes[2] +
                      across[3] * nodes[3]);
  }
  return sum;
}

SightRay LensView::RayTowards(const Eigen::Vector3d& direction_in_cam) const {
  return {stage_from_cam_.translation_mm,
          (rotation_stage_from_cam_ * direction_in_cam).normalized()};
}

std::optional<SightRay> LensView::RayThrough(const Eigen::Vector2d& point_px) const {
  const Eigen::Vector2d place = (point_px / kStep_px).array() + kMargin;
  const Eigen::Vector2d cell = place.array().floor();
  const bool in_table = cell.x() >= 0 && cell.y() >= 0 && cell.x() < columns_ && cell.y() < rows_;
  if (in_table) {
    const int column = static_cast<int>(cell.x());
    const int row = static_cast<int>(cell.y());
    if (usable_[static_cast<std::size_t>(row) * columns_ + column])
      return RayTowards(Interpolate(column, row, place - cell).homogeneous());
  }
  const auto direction = Unproject(camera_.lens, point_px);
  if (!direction) return std::nullopt;
  return RayTowards(*direction);
}

}  // namespace articap
