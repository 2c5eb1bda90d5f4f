// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

enum class BoardKind : std::uint8_t { kChessboard, kCharuco };

// A printed calibration board. The board frame: origin at the first corner, x along the rows to
// the right, y down the columns, z into the board, away from who looks at it; mm.
struct BoardSpec {
  BoardKind kind = BoardKind::kChessboard;
  // What people count: a chessboard by its inner corners, a ChArUco board by its squares.
  int columns = 9;
  int rows = 6;
  double square_mm = 25;
  double marker_mm = 0;    // ChArUco: side of a marker, black border included
  std::string dictionary;  // ChArUco: OpenCV's name of it, e.g. "DICT_5X5_250"

  bool operator==(const BoardSpec&) const = default;

  // Inner corners, in a row and rows of them.
  int corner_columns() const { return kind == BoardKind::kCharuco ? columns - 1 : columns; }
  int corner_rows() const { return kind == BoardKind::kCharuco ? rows - 1 : rows; }
  int num_corners() const { return corner_columns() * corner_rows(); }
  int square_columns() const { return corner_columns() + 1; }
  int square_rows() const { return corner_rows() + 1; }
  // Corners are numbered row by row, from 0.
  Eigen::Vector3d corner_in_board_mm(int corner) const {
    const int row = corner / corner_columns(), column = corner % corner_columns();
    return {square_mm * column, square_mm * row, 0};
  }
  // Whether the board, turned by 180 degrees in its plane, looks the same, so that one picture
  // does not tell which corner is the first.
  bool is_ambiguous() const;
};

// "chessboard:9x6:25" (inner corners, square mm) or "charuco:7x5:12:9[:DICT_5X5_250]" (squares,
// square mm, marker mm, dictionary). The message says what is wrong and shows an example.
Result<BoardSpec> ParseBoardSpec(std::string_view text);
// The same text again, dictionary included.
std::string NameOf(const BoardSpec& board);

// An axis-parallel rectangle in the board frame.
struct BoardRectangle {
  Eigen::Vector2d min_mm;
  Eigen::Vector2d max_mm;
};

// What is printed: dark rectangles on white paper. Of a chessboard the squares; of a ChArUco board
// also the markers' cells.
struct BoardPattern {
  BoardRectangle paper;  // with a white margin of one square around the squares
  std::vector<BoardRectangle> dark;
};

// The squares of a board, without markers: square (0, 0), above and to the left of the first
// corner, is dark.
BoardPattern SquaresOf(const BoardSpec& board);

}  // namespace articap
