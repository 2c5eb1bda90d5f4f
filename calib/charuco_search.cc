// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>

#include "calib/board_markers.h"
#include "calib/corner_search.h"
#include "calib/opencv_picture.h"

namespace articap {
namespace {

// A marker of the dictionary in the picture.
struct SeenMarker {
  int id;
  std::array<Eigen::Vector2d, 4> corners_px;
};

// A marker of the board, and where it is.
struct PlacedMarker {
  BoardMarker marker;
  std::array<Eigen::Vector2d, 4> corners_px;
};

std::vector<SeenMarker> MarkersIn(const GrayPicture& picture, int dictionary) {
  // Cells of two pixels can be read; OpenCV's own limit grows with the picture.
  constexpr double kLeastPerimeter_px = 4 * 14;
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->minMarkerPerimeterRate =
      std::min(parameters->minMarkerPerimeterRate,
               kLeastPerimeter_px / std::max(picture.width, picture.height));
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(EightBitsOf(picture), cv::aruco::getPredefinedDictionary(dictionary),
                           corners, ids, parameters);
  std::vector<SeenMarker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    SeenMarker marker{ids[i], {}};
    for (std::size_t k = 0; k < 4; ++k) marker.corners_px[k] = {corners[i][k].x, corners[i][k].y};
    markers.push_back(marker);
  }
  return markers;
}

cv::Point2d PointOf(const Eigen::Vector2d& point) { return {point.x(), point.y()}; }

// The corners of markers on the board, in squares, and in the picture.
struct MarkerPoints {
  std::vector<cv::Point2d> squares, points_px;
};

MarkerPoints PointsOf(const BoardSpec& board, const std::vector<PlacedMarker>& markers) {
  MarkerPoints at;
  for (const PlacedMarker& placed : markers) {
    const auto corners = CornersInSquares(board, placed.marker);
    for (std::size_t k = 0; k < 4; ++k) {
      at.squares.push_back(PointOf(corners[k]));
      at.points_px.push_back(PointOf(placed.corners_px[k]));
    }
  }
  return at;
}

// Those that lie as a plane board shows them. Lenses bend it: a third of a square is allowed.
std::vector<PlacedMarker> Consistent(const BoardSpec& board,
                                     const std::vector<PlacedMarker>& markers) {
  constexpr double kMostOff_squares = 0.3;
  if (markers.size() < 2) return markers;
  const MarkerPoints at = PointsOf(board, markers);
  std::vector<unsigned char> is_inlier;
  if (cv::findHomography(at.points_px, at.squares, cv::RANSAC, kMostOff_squares, is_inlier).empty())
    return {};
  std::vector<PlacedMarker> consistent;
  for (std::size_t i = 0; i < markers.size(); ++i)
    if (std::all_of(&is_inlier[4 * i], &is_inlier[4 * i] + 4, [](unsigned char is) { return is; }))
      consistent.push_back(markers[i]);
  return consistent;
}

std::vector<PlacedMarker> Place(const BoardSpec& board, const std::vector<SeenMarker>& seen,
                                MarkerLayout layout) {
  const std::vector<BoardMarker> markers = MarkersOf(board, layout);
  std::vector<PlacedMarker> placed;
  for (const SeenMarker& marker : seen)
    if (marker.id < static_cast<int>(markers.size()))
      placed.push_back({markers[marker.id], marker.corners_px});
  return Consistent(board, placed);
}

// Steps from the corner to the middle of the marker, in squares.
double DistanceTo(const Eigen::Vector2d& corner, const BoardMarker& marker) {
  return (Eigen::Vector2d(marker.column - 0.5, marker.row - 0.5) - corner).cwiseAbs().maxCoeff();
}

// Through the homography of the markers around it, which lenses hardly bend. Nothing where there is
// none within a square: of the two that touch a corner both may be unreadable while it is clear.
std::optional<Eigen::Vector2d> Predict(const BoardSpec& board, const Eigen::Vector2d& corner,
                                       std::vector<PlacedMarker> markers) {
  constexpr std::size_t kMarkersAround = 4;
  const auto is_nearer = [&](const PlacedMarker& a, const PlacedMarker& b) {
    return std::pair(DistanceTo(corner, a.marker), a.marker.id) <
           std::pair(DistanceTo(corner, b.marker), b.marker.id);
  };
  std::sort(markers.begin(), markers.end(), is_nearer);
  if (DistanceTo(corner, markers.front().marker) > 1.6) return std::nullopt;
  markers.resize(std::min(markers.size(), kMarkersAround));
  const MarkerPoints at = PointsOf(board, markers);
  const cv::Mat homography = cv::findHomography(at.squares, at.points_px);
  if (homography.empty()) return std::nullopt;
  std::vector<cv::Point2d> predicted;
  cv::perspectiveTransform(std::vector<cv::Point2d>{PointOf(corner)}, predicted, homography);
  return Eigen::Vector2d(predicted[0].x, predicted[0].y);
}

std::string TooFew(const BoardSpec& board, std::size_t placed, std::size_t seen) {
  if (seen == 0) return fmt::format("no board found: no marker of {} is seen", board.dictionary);
  return fmt::format("only {} of {} markers{}", placed, MarkersOf(board).size(),
                     seen > placed ? fmt::format("; {} more of {} are not of this board, or not "
                                                 "in their places",
                                                 seen - placed, board.dictionary)
                                   : "");
}

}  // namespace

Result<RoughCorners> FindCharuco(const GrayPicture& picture, const BoardSpec& board) {
  constexpr std::size_t kFewestMarkers = 3;
  const Result<int> dictionary = DictionaryOf(board);
  if (!dictionary) return tl::unexpected(dictionary.error());
  const std::vector<SeenMarker> seen = MarkersIn(picture, *dictionary);
  const std::vector<PlacedMarker> markers = Place(board, seen, MarkerLayout::kSince46);
  const std::size_t otherwise = Place(board, seen, MarkerLayout::kBefore46).size();
  if (otherwise >= kFewestMarkers && otherwise > markers.size())
    return Fail(
        "a board that begins with a white square, as OpenCV before 4.6 printed those with an even "
        "number of rows; print a new one with 'articap calibrate print'");
  if (markers.size() < kFewestMarkers) return Fail(TooFew(board, markers.size(), seen.size()));
  RoughCorners corners;
  for (int corner = 0; corner < board.num_corners(); ++corner) {
    const Eigen::Vector2d squares = board.corner_in_board_mm(corner).head<2>() / board.square_mm;
    const auto point_px = Predict(board, squares, markers);
    if (!point_px || !picture.Contains(*point_px)) continue;
    corners.corners.push_back(corner);
    corners.points_px.push_back(*point_px);
  }
  return corners;
}

}  // namespace articap
