// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/board.h"
#include "core/result.h"

namespace articap {

// Which squares of a ChArUco board are white and hold the markers, numbered row by row. OpenCV
// begins every board with a dark square since 4.6; before, those with an even number of rows began
// with a white one.
enum class MarkerLayout : std::uint8_t { kSince46, kBefore46 };

// A marker of a ChArUco board and the square that it stands in.
struct BoardMarker {
  int id = 0;  // in the dictionary
  int column = 0;
  int row = 0;
};

// In the order of their ids, from 0.
std::vector<BoardMarker> MarkersOf(const BoardSpec& board,
                                   MarkerLayout layout = MarkerLayout::kSince46);

// A marker's corners, from the top left one clockwise, in squares from the board's first corner.
std::array<Eigen::Vector2d, 4> CornersInSquares(const BoardSpec& board, const BoardMarker& marker);

// OpenCV's number of the board's dictionary. Fails with the names of those that would do where
// there is none of this name, or it has fewer markers than the board.
Result<int> DictionaryOf(const BoardSpec& board);

}  // namespace articap
