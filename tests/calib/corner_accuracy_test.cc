// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "calib/board_detector.h"
#include "tests/calib/board_picture.h"

namespace articap {
namespace {

constexpr double kPi = std::numbers::pi;

// Errors of the corners of many pictures.
struct Errors {
  int corners = 0;
  int expected = 0;
  double sum_squares = 0;          // px2, both axes
  double sum_claimed_squares = 0;  // of the standard deviations that the detector gives
  double worst_px = 0;

  double rmse_px() const { return std::sqrt(sum_squares / (2 * corners)); }  // of an axis
  double claimed_px() const { return std::sqrt(sum_claimed_squares / corners); }
};

void Add(const DetectedBoard& found, const std::vector<Eigen::Vector2d>& truth, Errors& errors) {
  errors.expected += static_cast<int>(truth.size());
  for (std::size_t i = 0; i < found.corners.size(); ++i) {
    const double error_px = (found.points_px[i] - truth[found.corners[i]]).norm();
    ++errors.corners;
    errors.sum_squares += error_px * error_px;
    errors.sum_claimed_squares += found.sigmas_px[i] * found.sigmas_px[i];
    errors.worst_px = std::max(errors.worst_px, error_px);
  }
}

// A board in several poses, tilted up to 45 degrees, before a lens with barrel distortion.
Errors Measure(const char* board_name, BoardPictureOptions options) {
  const BoardSpec board = ParseBoardSpec(board_name).value();
  options.lens.fx_px = options.lens.fy_px = 533;
  options.lens.distortion[Lens::kK1] = -0.28;
  Errors errors;
  for (int view = 0; view < 4; ++view) {
    BoardPose pose = BoardPose::Turned(0.4 * view - 0.6, 0.6 - 0.35 * view, 0.9 * view);
    pose.middle_mm = Eigen::Vector3d(20 * (view % 3) - 20, 15 * (view % 2) - 7, 420 + 30 * view);
    options.seed = view + 1;
    const DetectionResult result = DetectBoard(PictureOf(board, pose, options).view(), {}, board);
    EXPECT_EQ(result.boards.size(), 1U) << board_name << ", view " << view << result.reason;
    if (!result.boards.empty()) Add(result.boards[0], TrueCorners(board, pose, options), errors);
  }
  return errors;
}

// What remains is that pixels are squares and no Gaussians, and the rounding to 8 bits.
TEST(CornerAccuracyTest, WithoutNoiseErrorsAreBelowAHundredthOfAPixel) {
  const Errors errors = Measure("chessboard:9x6:20", {.blur_px = 0.7});
  EXPECT_EQ(errors.corners, errors.expected);
  EXPECT_LT(errors.rmse_px(), 0.01);
  EXPECT_LT(errors.worst_px, 0.08);
}

TEST(CornerAccuracyTest, UnderNoiseTheErrorIsWhatTheSigmasSay) {
  for (const double blur_px : {0.5, 1.5})
    for (const double noise : {0.01, 0.03}) {
      const Errors errors = Measure("chessboard:9x6:20", {.blur_px = blur_px, .noise = noise});
      EXPECT_EQ(errors.corners, errors.expected);
      // The sigmas are of the larger axis, and include what wide blur lets in from other squares;
      // they know nothing of the 64 samples and 8 bits that the picture is made of.
      EXPECT_LT(errors.rmse_px(), 1.15 * errors.claimed_px() + 0.005) << blur_px << " " << noise;
      EXPECT_GT(errors.rmse_px(), 0.5 * errors.claimed_px()) << blur_px << " " << noise;
      EXPECT_LT(errors.worst_px, 6 * errors.claimed_px() + 0.03) << blur_px << " " << noise;
    }
}

TEST(CornerAccuracyTest, MarkersBesideACornerDoNotDragIt) {
  const Errors errors = Measure("charuco:8x6:24:18", {.blur_px = 0.6, .noise = 0.01});
  EXPECT_GT(errors.corners, 0.95 * errors.expected);
  EXPECT_LT(errors.rmse_px(), 0.025);
  EXPECT_LT(errors.worst_px, 0.15);
}

TEST(CornerAccuracyTest, LightThatFallsOffDoesNotDragCorners) {
  const Errors errors = Measure("chessboard:9x6:20", {.falloff = 0.7, .blur_px = 0.8});
  EXPECT_LT(errors.rmse_px(), 0.015);
}

// The Cramer-Rao bound of a corner's coordinate under white noise of SD `noise`, from the edge of
// length 2 `half_px` that crosses it with a step `step`, blurred by a Gaussian of SD `blur_px`. A
// piece dl of the edge tells its place with the information step2 / (2 sqrt(pi) blur noise2) dl,
// the integral of the squared gradient; near the crossing the other edge blurs the step to a part
// erf(l / (sqrt(2) blur)). The edge's curvature is not known either (its direction, odd in l, does
// not matter), so the bound is that of the intercept of a fit by 1 and l2.
double Bound(double noise, double step, double blur_px, double half_px) {
  double m0 = 0, m2 = 0, m4 = 0;
  constexpr int kPieces = 2000;
  const double piece_px = 2 * half_px / kPieces;
  for (int i = 0; i < kPieces; ++i) {
    const double l = -half_px + (i + 0.5) * piece_px;
    const double part = std::erf(l / (std::numbers::sqrt2 * blur_px));
    m0 += part * part * piece_px;
    m2 += part * part * piece_px * l * l;
    m4 += part * part * piece_px * l * l * l * l;
  }
  return noise / step * std::sqrt(2 * std::sqrt(kPi) * blur_px * m4 / (m0 * m4 - m2 * m2));
}

TEST(CornerAccuracyTest, NoUnbiasedEstimateCouldBeMuchBetter) {
  const BoardSpec board = ParseBoardSpec("chessboard:9x6:20").value();
  BoardPictureOptions options{.blur_px = 1.0, .noise = 0.02, .quantized = false};
  const BoardPose pose;
  Errors errors;
  for (int seed = 1; seed <= 5; ++seed) {
    options.seed = seed;
    const DetectionResult result = DetectBoard(PictureOf(board, pose, options).view(), {}, board);
    ASSERT_EQ(result.boards.size(), 1U) << result.reason;
    Add(result.boards[0], TrueCorners(board, pose, options), errors);
  }
  const double spacing_px = board.square_mm * options.lens.fx_px / pose.middle_mm.z();
  // Pixels are squares: they blur by 1/12 px2 too. Corners are fitted up to 0.4 squares around.
  const double bound_px =
      Bound(options.noise, options.white - options.black,
            std::sqrt(options.blur_px * options.blur_px + 1.0 / 12), 0.4 * spacing_px);
  RecordProperty("rmse_px", std::to_string(errors.rmse_px()));
  RecordProperty("bound_px", std::to_string(bound_px));
  // That the light may fall off, and 540 errors, leave this much.
  EXPECT_LT(errors.rmse_px(), 1.2 * bound_px);
  EXPECT_GT(errors.rmse_px(), 0.95 * bound_px);
}

}  // namespace
}  // namespace articap
