// SPDX-License-Identifier: MIT
#include "calib/board_detector.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "calib/corner_measurement.h"
#include "calib/corner_search.h"
#include "calib/gray_picture.h"
#include "calib/opencv_picture.h"

namespace articap {
namespace {

// No board has room in less, and OpenCV's detectors expect some pixels.
constexpr int kLeastPicture_px = 32;
// A board that is so small, or seen so partly, tells nothing that others do not tell better.
constexpr std::size_t kFewestCorners = 6;
// Corners of a chessboard that may be hidden or unclear.
constexpr double kLeastPartOfChessboard = 0.8;
// Edges so wide that those of neighbouring squares run into one another.
constexpr double kMostEdgePerSpacing = 0.5;

Result<void> CheckQuality(const BoardQuality& quality, const DetectorOptions& options) {
  const double most_edge_px =
      std::min(options.max_edge_px, kMostEdgePerSpacing * quality.spacing_px);
  if (quality.edge_px > most_edge_px)
    return Fail(fmt::format("too blurred (edges {:.1f} px wide, at most {:.1f} are of use)",
                            quality.edge_px, most_edge_px));
  if (quality.saturated > options.max_saturated)
    return Fail(fmt::format("overexposed ({:.0f} % of the board's white saturated); expose less",
                            100 * quality.saturated));
  return {};
}

Result<void> CheckCorners(const BoardSpec& board, const std::vector<int>& corners) {
  const std::size_t fewest =
      board.kind == BoardKind::kCharuco
          ? kFewestCorners
          : static_cast<std::size_t>(std::ceil(kLeastPartOfChessboard * board.num_corners()));
  if (corners.size() < fewest)
    return Fail(fmt::format("only {} of {} corners are clear; {} are needed", corners.size(),
                            board.num_corners(), fewest));
  if (!SpanPlane(board, corners))
    return Fail(fmt::format("the {} corners in view are on a line", corners.size()));
  return {};
}

// The board as it is seen unreversed, or why not.
Result<DetectedBoard> DetectUpright(const GrayPicture& picture, const BoardSpec& board,
                                    const DetectorOptions& options) {
  const Result<RoughCorners> rough = board.kind == BoardKind::kCharuco
                                         ? FindCharuco(picture, board)
                                         : FindChessboard(picture, board, options.thorough);
  if (!rough) return tl::unexpected(rough.error());
  if (const auto enough = CheckCorners(board, rough->corners); !enough)
    return tl::unexpected(enough.error());
  MeasuredCorners measured = MeasureCorners(picture, board, *rough, options.window_px);
  if (const auto good = CheckQuality(measured.quality, options); !good)
    return tl::unexpected(good.error());
  if (const auto enough = CheckCorners(board, measured.corners); !enough)
    return tl::unexpected(enough.error());
  DetectedBoard found;
  found.corners = std::move(measured.corners);
  for (const CornerFit& fit : measured.fits) {
    found.points_px.push_back(fit.point_px);
    found.sigmas_px.push_back(fit.sigma_px);
  }
  found.quality = measured.quality;
  return found;
}

// The picture with the board painted over, its outermost squares included.
GrayPicture Without(GrayPicture picture, const BoardSpec& board, const DetectedBoard& found) {
  const BoardHomography homography(board, found.corners, found.points_px);
  const double right = board.corner_columns(), bottom = board.corner_rows();
  std::vector<cv::Point> outline;
  for (const Eigen::Vector2d& squares :
       {Eigen::Vector2d(-1, -1), Eigen::Vector2d(right, -1), Eigen::Vector2d(right, bottom),
        Eigen::Vector2d(-1, bottom)}) {
    const Eigen::Vector2d point_px = homography(squares);
    outline.emplace_back(cv::saturate_cast<int>(point_px.x()),
                         cv::saturate_cast<int>(point_px.y()));
  }
  cv::Mat pixels = MatOf(picture);
  cv::fillConvexPoly(pixels, outline, cv::mean(pixels));
  return picture;
}

// In the reversed picture, corners are where a mirror shows them.
DetectedBoard SeenInMirror(DetectedBoard found, int picture_width) {
  found.mirrored = true;
  for (Eigen::Vector2d& point_px : found.points_px) point_px.x() = picture_width - 1 - point_px.x();
  return found;
}

// Across the direction in which it is tilted away, a board appears as large as it is near.
double Nearness(const BoardSpec& board, const DetectedBoard& found) {
  const BoardHomography homography(board, found.corners, found.points_px);
  const Eigen::Vector2d middle(0.5 * (board.corner_columns() - 1), 0.5 * (board.corner_rows() - 1));
  return Eigen::JacobiSVD<Eigen::Matrix2d>(homography.PxFromSquares(middle)).singularValues()[0];
}

DetectionResult Both(const Result<DetectedBoard>& direct, const Result<DetectedBoard>& in_mirror,
                     int picture_width) {
  DetectionResult result;
  if (direct) result.boards.push_back(*direct);
  if (in_mirror) result.boards.push_back(SeenInMirror(*in_mirror, picture_width));
  if (result.boards.empty()) result.reason = direct.error().message;
  return result;
}

// A reversed chessboard is a chessboard too, so that either sighting is found both ways. Seen in a
// mirror it is further away.
DetectionResult DetectChessboardTwice(const GrayPicture& picture, const GrayPicture& reversed,
                                      const BoardSpec& board, const DetectorOptions& options) {
  const Result<DetectedBoard> first = DetectUpright(picture, board, options);
  if (!first) return {{}, first.error().message};
  const Result<DetectedBoard> second =
      DetectUpright(Reversed(Without(picture, board, *first)), board, options);
  if (!second || Nearness(board, *first) >= Nearness(board, *second))
    return Both(first, second, picture.width);
  return Both(DetectUpright(Reversed(Without(reversed, board, *second)), board, options),
              DetectUpright(Reversed(Without(picture, board, *first)), board, options),
              picture.width);
}

}  // namespace

void VisitOptions(DetectorOptions& options, OptionVisitor& visit) {
  visit("look_in_mirror", options.look_in_mirror, "look for the board in a mirror too");
  visit("thorough", options.thorough, "try harder where no board is found at first");
  visit("window_px", options.window_px,
        "half side of the window that a corner is fitted to; 0: by the squares; px");
  visit("max_edge_px", options.max_edge_px, "pictures with wider edges are refused; px");
  visit("max_saturated", options.max_saturated,
        "pictures with a larger part of the board's white saturated are refused");
}

Result<void> CheckOptions(const DetectorOptions& options) {
  if (const auto positive = RequirePositive({{"max_edge_px", options.max_edge_px}}); !positive)
    return positive;
  return RequireNotNegative(
      {{"window_px", options.window_px}, {"max_saturated", options.max_saturated}});
}

DetectionResult DetectBoard(const ImageView& image, const PictureFromImage& picture_from_image,
                            const BoardSpec& board, const DetectorOptions& options) {
  const GrayPicture picture = GrayPictureOf(image, picture_from_image);
  if (std::min(picture.width, picture.height) < kLeastPicture_px)
    return {{},
            fmt::format("no board found: the picture has only {} x {} px", picture.width,
                        picture.height)};
  if (!options.look_in_mirror) {
    const Result<DetectedBoard> direct = DetectUpright(picture, board, options);
    return direct ? DetectionResult{{*direct}, {}} : DetectionResult{{}, direct.error().message};
  }
  const GrayPicture reversed = Reversed(picture);
  if (board.kind == BoardKind::kChessboard)
    return DetectChessboardTwice(picture, reversed, board, options);
  return Both(DetectUpright(picture, board, options), DetectUpright(reversed, board, options),
              picture.width);
}

}  // namespace articap
