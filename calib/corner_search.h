// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib/gray_picture.h"
#include "core/board.h"
#include "core/result.h"

namespace articap {

// Corners of a board, roughly: to a pixel or two, for FitCorner() to go on from.
struct RoughCorners {
  std::vector<int> corners;  // numbers of the board's corners, ascending
  std::vector<Eigen::Vector2d> points_px;
};

// The corners of a chessboard that is seen as it is, not in a mirror, numbered so that the square
// above and to the left of corner 0 is dark; where the board is ambiguous, so that its rows lead
// rather to the right than to the left. All of its squares must be in the picture. `thorough` tries
// harder, for up to a second. A failure says what was found instead.
Result<RoughCorners> FindChessboard(const GrayPicture& picture, const BoardSpec& board,
                                    bool thorough);

// The corners of a ChArUco board in the picture that have a marker nearby; some may be hidden.
Result<RoughCorners> FindCharuco(const GrayPicture& picture, const BoardSpec& board);

}  // namespace articap
