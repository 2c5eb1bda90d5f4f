// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib/gray_picture.h"

namespace articap {

// Inner corners of a chessboard in rows.
struct CornerGrid {
  int columns = 0;
  int rows = 0;
  std::vector<Eigen::Vector2d> points_px;  // row by row

  const Eigen::Vector2d& at(int column, int row) const { return points_px[row * columns + column]; }
  // Bilinear between corners, and beyond the outermost ones as in the cell beside them: (0.5, 0.5)
  // is the middle of the square to the lower right of the first corner.
  Eigen::Vector2d Between(double column, double row) const;
};

// The same corners in the order of the board: right-handed in the picture, with a dark square above
// and to the left of the first corner; of several such orders, the one whose rows lead furthest to
// the right. Nothing where the squares do not alternate as those of a chessboard.
std::optional<CornerGrid> InBoardOrder(const CornerGrid& grid, const GrayPicture& picture);

// Whether the squares go on alternating behind the outermost ones: a part of a larger board.
bool GoesOn(const CornerGrid& grid, const GrayPicture& picture);

}  // namespace articap
