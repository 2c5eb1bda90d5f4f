// SPDX-License-Identifier: MIT
#include "calib/board_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/aruco.hpp>
#include <string>

#include "core/check.h"

namespace articap {
namespace {

struct NamedDictionary {
  const char* name;
  int number;
};

constexpr NamedDictionary kDictionaries[] = {
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
};

int MarkersIn(int dictionary) {
  return cv::aruco::getPredefinedDictionary(dictionary)->bytesList.rows;
}

// The names of those with this many markers at least.
std::string NamesOfDictionaries(int markers) {
  std::string names;
  for (const NamedDictionary& entry : kDictionaries)
    if (MarkersIn(entry.number) >= markers)
      names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  return names.empty() ? "none" : names;
}

}  // namespace

std::vector<BoardMarker> MarkersOf(const BoardSpec& board, MarkerLayout layout) {
  ARTICAP_CHECK(board.kind == BoardKind::kCharuco);
  const bool begins_white = layout == MarkerLayout::kBefore46 && board.rows % 2 == 0;
  std::vector<BoardMarker> markers;
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      if (((row + column) % 2 == 0) == begins_white)
        markers.push_back({static_cast<int>(markers.size()), column, row});
  return markers;
}

std::array<Eigen::Vector2d, 4> CornersInSquares(const BoardSpec& board, const BoardMarker& marker) {
  const double near = 0.5 * (1 - board.marker_mm / board.square_mm), far = 1 - near;
  const Eigen::Vector2d square(marker.column - 1, marker.row - 1);
  return {square + Eigen::Vector2d(near, near), square + Eigen::Vector2d(far, near),
          square + Eigen::Vector2d(far, far), square + Eigen::Vector2d(near, far)};
}

Result<int> DictionaryOf(const BoardSpec& board) {
  const auto named = [&](const NamedDictionary& entry) { return entry.name == board.dictionary; };
  const auto* const found = std::find_if(std::begin(kDictionaries), std::end(kDictionaries), named);
  const int markers = static_cast<int>(MarkersOf(board).size());
  if (found == std::end(kDictionaries))
    return Fail(fmt::format("'{}' is no dictionary of markers; a {}x{} board takes one of: {}",
                            board.dictionary, board.columns, board.rows,
                            NamesOfDictionaries(markers)));
  if (MarkersIn(found->number) < markers)
    return Fail(
        fmt::format("a {}x{} board has {} markers, and {} only {}; dictionaries that have "
                    "enough: {}",
                    board.columns, board.rows, markers, board.dictionary, MarkersIn(found->number),
                    NamesOfDictionaries(markers)));
  return found->number;
}

}  // namespace articap
