// SPDX-License-Identifier: MIT
#include "calib/board_pattern.h"

#include <opencv2/aruco.hpp>

#include "calib/board_markers.h"

namespace articap {
namespace {

// Dark cells side by side in a row of the marker are one rectangle.
void AddCells(const cv::Mat& cells, const Eigen::Vector2d& top_left_mm, double cell_mm,
              BoardPattern& pattern) {
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.cols;) {
      if (cells.at<unsigned char>(row, column) != 0) {
        ++column;
        continue;
      }
      const int first = column;
      while (column < cells.cols && cells.at<unsigned char>(row, column) == 0) ++column;
      pattern.dark.push_back({top_left_mm + cell_mm * Eigen::Vector2d(first, row),
                              top_left_mm + cell_mm * Eigen::Vector2d(column, row + 1)});
    }
}

}  // namespace

Result<BoardPattern> PatternOf(const BoardSpec& board) {
  BoardPattern pattern = SquaresOf(board);
  if (board.kind == BoardKind::kChessboard) return pattern;
  const Result<int> number = DictionaryOf(board);
  if (!number) return tl::unexpected(number.error());
  const cv::Ptr<cv::aruco::Dictionary> dictionary = cv::aruco::getPredefinedDictionary(*number);
  const int cells = dictionary->markerSize + 2;  // with the border
  for (const BoardMarker& marker : MarkersOf(board)) {
    cv::Mat drawn;
    dictionary->drawMarker(marker.id, cells, drawn);
    AddCells(drawn, board.square_mm * CornersInSquares(board, marker)[0], board.marker_mm / cells,
             pattern);
  }
  return pattern;
}

}  // namespace articap
