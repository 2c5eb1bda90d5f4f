// SPDX-License-Identifier: MIT
#pragma once

#include "core/board.h"
#include "core/result.h"

namespace articap {

// What is printed of a board, markers included. The first square of a ChArUco board is dark,
// whatever the number of its rows, and its markers stand in the white squares, row by row: the
// layout of OpenCV since 4.6. Before, boards with an even number of rows began with a white square.
Result<BoardPattern> PatternOf(const BoardSpec& board);

}  // namespace articap
