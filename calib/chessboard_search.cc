// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "calib/corner_grid.h"
#include "calib/corner_search.h"
#include "calib/opencv_picture.h"

namespace articap {
namespace {

using Points = std::vector<cv::Point2f>;

// One way to look for the grid.
struct Attempt {
  bool by_sectors;  // OpenCV's newer detector; else the one that joins dark squares
  double longest_side_px;
  double smoothing_px;  // SD of a Gaussian
  int flags;
};

constexpr int kQuads = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
constexpr int kSectors = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE;

// Each finds boards that the others miss. Small pictures first: they cost little, and the corners
// are refined in the full one anyway. The detector that joins squares takes ten seconds over noise
// where it is large and sharp, the other one does not.
std::vector<Attempt> AttemptsOf(bool thorough) {
  const Attempt quick{false, 800, 0, kQuads | cv::CALIB_CB_FAST_CHECK};
  if (!thorough) return {quick, {true, 800, 0, 0}};
  return {quick, {true, 1200, 0, kSectors}, {false, 400, 1, kQuads}, {true, 2000, 0, kSectors}};
}

// The picture, smaller if need be, and how many of its pixels are one there.
std::pair<cv::Mat, double> Shrunk(const cv::Mat& picture, double longest_side_px) {
  const double factor = std::max(1.0, std::max(picture.rows, picture.cols) / longest_side_px);
  if (factor == 1) return {picture, 1};
  cv::Mat small;
  cv::resize(picture, small, {}, 1 / factor, 1 / factor, cv::INTER_AREA);
  return {small, static_cast<double>(picture.cols) / small.cols};
}

// Pixel centres keep their places: (x + 0.5) / factor - 0.5 in the smaller picture.
CornerGrid GridOf(const Points& points, cv::Size size, double factor) {
  CornerGrid grid{size.width, size.height, {}};
  for (const cv::Point2f& point : points)
    grid.points_px.emplace_back((point.x + 0.5) * factor - 0.5, (point.y + 0.5) * factor - 0.5);
  return grid;
}

// Squares of fewer pixels are no board's: the detectors' own windows are as large.
constexpr double kLeastSpacing_px = 4;

double LeastSpacing(const CornerGrid& grid) {
  double least_px = std::numeric_limits<double>::infinity();
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (column > 0)
        least_px = std::min(least_px, (grid.at(column, row) - grid.at(column - 1, row)).norm());
      if (row > 0)
        least_px = std::min(least_px, (grid.at(column, row) - grid.at(column, row - 1)).norm());
    }
  return least_px;
}

std::optional<CornerGrid> Try(const Attempt& attempt, const cv::Mat& picture, cv::Size size) {
  auto [small, factor] = Shrunk(picture, attempt.longest_side_px);
  if (attempt.smoothing_px > 0) {
    cv::Mat smooth;  // not in place: it may be the picture itself
    cv::GaussianBlur(small, smooth, {}, attempt.smoothing_px);
    small = smooth;
  }
  Points points;
  const bool found = attempt.by_sectors
                         ? cv::findChessboardCornersSB(small, size, points, attempt.flags)
                         : cv::findChessboardCorners(small, size, points, attempt.flags);
  if (!found) return std::nullopt;
  CornerGrid grid = GridOf(points, size, factor);
  if (LeastSpacing(grid) < kLeastSpacing_px) return std::nullopt;
  return grid;
}

// The largest chessboard in sight, for a message; 0 x 0 where there is none.
cv::Size LargestGrid(const cv::Mat& picture) {
  const auto [small, factor] = Shrunk(picture, 1000);
  Points points;
  cv::Mat meta;
  const bool found = cv::findChessboardCornersSB(
      small, {3, 3}, points, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER, meta);
  return found ? meta.size() : cv::Size();
}

Error NothingFound(const cv::Mat& picture, const BoardSpec& board, bool thorough) {
  if (!thorough) return {"no board found"};
  const cv::Size seen = LargestGrid(picture);
  if (seen.area() == 0) return {"no board found"};
  const int longer = std::max(seen.width, seen.height), shorter = std::min(seen.width, seen.height);
  const bool is_part = longer <= std::max(board.columns, board.rows) &&
                       shorter <= std::min(board.columns, board.rows);
  return {fmt::format("a board with another number of corners: {}x{} seen, {}x{} wanted{}", longer,
                      shorter, board.columns, board.rows,
                      is_part ? "; is it all in the picture, and nothing before it?" : "")};
}

RoughCorners CornersOf(CornerGrid grid) {
  RoughCorners corners;
  corners.corners.resize(grid.points_px.size());
  std::iota(corners.corners.begin(), corners.corners.end(), 0);
  corners.points_px = std::move(grid.points_px);
  return corners;
}

}  // namespace

Result<RoughCorners> FindChessboard(const GrayPicture& picture, const BoardSpec& board,
                                    bool thorough) {
  const cv::Mat eight_bits = EightBitsOf(picture);
  const cv::Size size(board.columns, board.rows);
  bool goes_on = false;
  for (const Attempt& attempt : AttemptsOf(thorough)) {
    const std::optional<CornerGrid> found = Try(attempt, eight_bits, size);
    if (!found) continue;
    std::optional<CornerGrid> grid = InBoardOrder(*found, picture);
    if (!grid) continue;
    if (!GoesOn(*grid, picture)) return CornersOf(*std::move(grid));
    goes_on = true;
  }
  if (goes_on)
    return Fail(fmt::format("a board with more than {}x{} corners", board.columns, board.rows));
  return tl::unexpected(NothingFound(eight_bits, board, thorough));
}

}  // namespace articap
