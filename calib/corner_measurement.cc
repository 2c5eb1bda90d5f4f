// SPDX-License-Identifier: MIT
#include "calib/corner_measurement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <utility>

#include "core/check.h"
#include "core/statistics.h"

namespace articap {
namespace {

// Longer edges lower the noise, but on real boards they are less straight: of the chessboards in
// Debian's opencv-doc 0.4 leaves the smallest residuals.
constexpr double kReach = 0.4;
// Small squares are fitted a little further, so that enough pixels remain.
constexpr double kLeastReach_px = 3.5;
constexpr double kMostReach = 0.6;
// Markers are blurred too.
constexpr double kPartOfArm = 0.7;
// 10 % to 90 % of a Gaussian's integral, in its standard deviations.
constexpr double kEdgeWidth = 2.5631;
// At the top of the scale: what 8 bits know as 254 and 255.
constexpr double kSaturated = 253.5 / 255;

// 0 where there are none.
template <class Get>
double MedianOver(const std::vector<CornerFit>& fits, const Get& get) {
  std::vector<double> values;
  for (const CornerFit& fit : fits) values.push_back(get(fit));
  return values.empty() ? 0 : MedianOf(std::move(values));
}

// How far markers are from the corners of the squares that they are printed in, squares.
double ArmOf(const BoardSpec& board) {
  if (board.kind != BoardKind::kCharuco) return std::numeric_limits<double>::infinity();
  return 0.5 * (1 - board.marker_mm / board.square_mm);
}

bool IsBrightAboveLeft(const BoardSpec& board, int corner) {
  return (corner % board.corner_columns() + corner / board.corner_columns()) % 2 != 0;
}

MeasuredCorners FitAll(const GrayPicture& picture, const BoardSpec& board,
                       const RoughCorners& rough, const BoardHomography& homography,
                       CornerWindow window) {
  MeasuredCorners measured;
  for (std::size_t i = 0; i < rough.corners.size(); ++i) {
    const int corner = rough.corners[i];
    window.px_from_squares = homography.PxFromSquares(SquaresOfCorner(board, corner));
    window.reach = std::clamp(kLeastReach_px / window.px_from_squares.colwise().norm().minCoeff(),
                              kReach, kMostReach);
    const auto fit = FitCorner(picture, rough.points_px[i], window);
    if (!fit || (fit->amplitude > 0) != IsBrightAboveLeft(board, corner)) continue;
    measured.corners.push_back(corner);
    measured.fits.push_back(*fit);
  }
  return measured;
}

// A reflection or a finger raises the residuals, and lowers the contrast.
void DropDoubtful(MeasuredCorners& measured) {
  constexpr double kLeastContrast = 0.4;
  constexpr double kMostSigma = 6;
  constexpr double kFineSigma_px = 0.1;
  const double amplitude =
      MedianOver(measured.fits, [](const CornerFit& fit) { return std::abs(fit.amplitude); });
  const double sigma_px =
      MedianOver(measured.fits, [](const CornerFit& fit) { return fit.sigma_px; });
  MeasuredCorners kept;
  for (std::size_t i = 0; i < measured.fits.size(); ++i) {
    const CornerFit& fit = measured.fits[i];
    if (std::abs(fit.amplitude) < kLeastContrast * amplitude) continue;
    if (fit.sigma_px > std::max(kMostSigma * sigma_px, kFineSigma_px)) continue;
    kept.corners.push_back(measured.corners[i]);
    kept.fits.push_back(fit);
  }
  measured = std::move(kept);
}

// Of points in the white squares beside the corners.
double SaturatedPart(const GrayPicture& picture, const BoardSpec& board,
                     const BoardHomography& homography, const MeasuredCorners& measured) {
  const double diagonal = std::min(0.35, 0.6 * ArmOf(board));
  int seen = 0, saturated = 0;
  for (std::size_t i = 0; i < measured.fits.size(); ++i) {
    const CornerFit& fit = measured.fits[i];
    const Eigen::Matrix2d px_from_squares =
        homography.PxFromSquares(SquaresOfCorner(board, measured.corners[i]));
    const double down = fit.amplitude > 0 ? diagonal : -diagonal;
    for (const Eigen::Vector2d& squares :
         {Eigen::Vector2d(diagonal, down), Eigen::Vector2d(-diagonal, -down)}) {
      const Eigen::Vector2d point_px = fit.point_px + px_from_squares * squares;
      if (!picture.Contains(point_px)) continue;
      ++seen;
      if (picture.At(point_px) > kSaturated) ++saturated;
    }
  }
  return seen == 0 ? 0 : static_cast<double>(saturated) / seen;
}

double MeanSpacing(const BoardSpec& board, const BoardHomography& homography,
                   const MeasuredCorners& measured) {
  double sum_px = 0;
  for (const int corner : measured.corners)
    sum_px += homography.PxFromSquares(SquaresOfCorner(board, corner)).colwise().norm().mean();
  return measured.corners.empty() ? 0 : sum_px / static_cast<double>(measured.corners.size());
}

}  // namespace

BoardHomography::BoardHomography(const BoardSpec& board, const std::vector<int>& corners,
                                 const std::vector<Eigen::Vector2d>& points_px) {
  ARTICAP_CHECK(SpanPlane(board, corners));
  std::vector<cv::Point2d> squares, points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d square = SquaresOfCorner(board, corners[i]);
    squares.emplace_back(square.x(), square.y());
    points.emplace_back(points_px[i].x(), points_px[i].y());
  }
  const cv::Mat homography = cv::findHomography(squares, points);
  if (!homography.empty()) cv::cv2eigen(homography, px_from_squares_);
}

Eigen::Vector2d BoardHomography::operator()(const Eigen::Vector2d& squares) const {
  return (px_from_squares_ * squares.homogeneous()).hnormalized();
}

Eigen::Matrix2d BoardHomography::PxFromSquares(const Eigen::Vector2d& squares) const {
  const Eigen::Vector3d point = px_from_squares_ * squares.homogeneous();
  return (px_from_squares_.topLeftCorner<2, 2>() -
          point.hnormalized() * px_from_squares_.bottomLeftCorner<1, 2>()) /
         point.z();
}

Eigen::Vector2d BoardHomography::DepthGradient(const Eigen::Vector2d& squares) const {
  const double depth = px_from_squares_.row(2) * squares.homogeneous();
  const Eigen::Vector2d per_square = px_from_squares_.bottomLeftCorner<1, 2>().transpose() / depth;
  return PxFromSquares(squares).transpose().inverse() * per_square;
}

Eigen::Vector2d SquaresOfCorner(const BoardSpec& board, int corner) {
  return board.corner_in_board_mm(corner).head<2>() / board.square_mm;
}

bool SpanPlane(const BoardSpec& board, const std::vector<int>& corners) {
  if (corners.size() < 4) return false;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const int corner : corners) mean += SquaresOfCorner(board, corner);
  mean /= static_cast<double>(corners.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  int off_line = 0;
  for (const int corner : corners) {
    const Eigen::Vector2d offset = SquaresOfCorner(board, corner) - mean;
    scatter += offset * offset.transpose();
  }
  // A homography needs two corners off any line through the others.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
  for (const int corner : corners)
    if (std::abs(axes.eigenvectors().col(0).dot(SquaresOfCorner(board, corner) - mean)) > 0.1)
      ++off_line;
  return axes.eigenvalues()[0] > 0.3 && off_line >= 3;
}

MeasuredCorners MeasureCorners(const GrayPicture& picture, const BoardSpec& board,
                               const RoughCorners& rough, double window_px) {
  const BoardHomography homography(board, rough.corners, rough.points_px);
  CornerWindow window;
  window.half_side_px = window_px;
  window.arm = kPartOfArm * ArmOf(board);
  MeasuredCorners measured = FitAll(picture, board, rough, homography, window);
  DropDoubtful(measured);
  measured.quality = {
      .edge_px =
          kEdgeWidth * MedianOver(measured.fits, [](const CornerFit& fit) { return fit.blur_px; }),
      .contrast = 2 * MedianOver(measured.fits,
                                 [](const CornerFit& fit) { return std::abs(fit.amplitude); }),
      .saturated = SaturatedPart(picture, board, homography, measured),
      .spacing_px = MeanSpacing(board, homography, measured)};
  return measured;
}

}  // namespace articap
