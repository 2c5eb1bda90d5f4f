// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/board_detector.h"
#include "calib/corner_fit.h"
#include "calib/corner_search.h"
#include "calib/gray_picture.h"
#include "core/board.h"

namespace articap {

// A plane to the picture, roughly: lenses bend it.
class BoardHomography {
 public:
  // Least squares over at least four corners that are not on a line.
  BoardHomography(const BoardSpec& board, const std::vector<int>& corners,
                  const std::vector<Eigen::Vector2d>& points_px);

  // Of board coordinates in squares from the first corner.
  Eigen::Vector2d operator()(const Eigen::Vector2d& squares) const;
  // Derivative of that: px a square.
  Eigen::Matrix2d PxFromSquares(const Eigen::Vector2d& squares) const;
  // How the board recedes there: gradient of the logarithm of its depth, 1/px.
  Eigen::Vector2d DepthGradient(const Eigen::Vector2d& squares) const;

 private:
  Eigen::Matrix3d px_from_squares_ = Eigen::Matrix3d::Identity();
};

Eigen::Vector2d SquaresOfCorner(const BoardSpec& board, int corner);
// Whether they are four at least and span a plane.
bool SpanPlane(const BoardSpec& board, const std::vector<int>& corners);

struct MeasuredCorners {
  std::vector<int> corners;
  std::vector<CornerFit> fits;
  BoardQuality quality;
};

// Refines the rough corners. Left out are those where there is nothing like a corner, or one whose
// dark squares are the wrong ones, whose contrast is far below that of the others, or whose place
// is far less certain. `window_px` as in DetectorOptions.
MeasuredCorners MeasureCorners(const GrayPicture& picture, const BoardSpec& board,
                               const RoughCorners& rough, double window_px);

}  // namespace articap
