// SPDX-License-Identifier: MIT
#include "calib/board_detector.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/core.hpp>

#include "synthetic/random.h"
#include "tests/calib/board_picture.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;

BoardSpec Board(const char* name) { return ParseBoardSpec(name).value(); }

// The largest distance from the truth; infinite where a corner of the board is missing that
// `missing_allowed` does not allow.
double WorstError(const DetectedBoard& found, const std::vector<Eigen::Vector2d>& truth,
                  std::size_t missing_allowed = 0) {
  if (found.corners.size() + missing_allowed < truth.size()) return INFINITY;
  double worst_px = 0;
  for (std::size_t i = 0; i < found.corners.size(); ++i)
    worst_px = std::max(worst_px, (found.points_px[i] - truth[found.corners[i]]).norm());
  return worst_px;
}

// Noise of this part of the scale leaves corners of these boards to 0.02 px.
constexpr double kNoise = 0.01;
constexpr double kTolerance_px = 0.1;

TEST(BoardDetectorTest, CornersKeepTheirNumbersHoweverTheBoardIsTurned) {
  for (const char* name : {"chessboard:9x6:20", "chessboard:6x9:15", "charuco:7x5:25:19"})
    for (const double turn : {0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 1.75}) {
      const BoardSpec board = Board(name);
      BoardPose pose = BoardPose::Turned(0.2, -0.3, turn * kPi);
      const BoardPictureOptions options{
          .width = 480,
          .height = 400,
          .lens = {.fx_px = 800, .fy_px = 800, .cx_px = 240, .cy_px = 200},
          .noise = kNoise};
      const DetectionResult result = DetectBoard(PictureOf(board, pose, options).view(), {}, board);
      ASSERT_EQ(result.boards.size(), 1U) << name << " " << turn << result.reason;
      EXPECT_FALSE(result.boards[0].mirrored);
      EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, pose, options)), kTolerance_px)
          << name << ", turned by " << turn << " pi";
    }
}

TEST(BoardDetectorTest, AnAmbiguousBoardIsCountedToTheRight) {
  const BoardSpec board = Board("chessboard:7x5:20");
  ASSERT_TRUE(board.is_ambiguous());
  const BoardPictureOptions options;
  const BoardPose upright = BoardPose::Turned(0, 0, 0.3);
  const BoardPose turned = BoardPose::Turned(0, 0, 0.3 + kPi);
  for (const BoardPose& pose : {upright, turned}) {
    const DetectionResult result = DetectBoard(PictureOf(board, pose, options).view(), {}, board);
    ASSERT_EQ(result.boards.size(), 1U) << result.reason;
    EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, upright, options)), kTolerance_px);
  }
}

TEST(BoardDetectorTest, AMirrorShowsTheBoardASecondTime) {
  for (const char* name : {"chessboard:6x5:12", "charuco:7x5:12:9:DICT_4X4_50"}) {
    const BoardSpec board = Board(name);
    const BoardPictureOptions options{
        .lens = {.fx_px = 1500, .fy_px = 1500, .cx_px = 319.5, .cy_px = 239.5}, .noise = kNoise};
    BoardPose direct = BoardPose::Turned(0.1, 0.3, 0.1);
    direct.middle_mm = {-55, 5, 600};
    // Reflected by a mirror on the right, and so further away.
    BoardPose behind = BoardPose::Turned(0.1, -0.4, -0.1).Reversed();
    behind.middle_mm = {65, 5, 680};
    const DetectionResult result = DetectBoard(PictureOf(board, {direct, behind}, options).view(),
                                               {}, board, {.look_in_mirror = true});
    ASSERT_EQ(result.boards.size(), 2U) << name << result.reason;
    EXPECT_FALSE(result.boards[0].mirrored);
    EXPECT_TRUE(result.boards[1].mirrored);
    EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, direct, options)), kTolerance_px);
    EXPECT_LT(WorstError(result.boards[1], TrueCorners(board, behind, options)), kTolerance_px);
  }
}

TEST(BoardDetectorTest, TheNearerOfTwoChessboardsIsTheDirectOneOnEitherSide) {
  const BoardSpec board = Board("chessboard:6x5:12");
  const BoardPictureOptions options{
      .lens = {.fx_px = 1500, .fy_px = 1500, .cx_px = 319.5, .cy_px = 239.5}};
  BoardPose direct = BoardPose::Turned(0.1, 0.3, 0.1);
  BoardPose behind = BoardPose::Turned(0.1, -0.4, -0.1).Reversed();
  for (const double side : {-1.0, 1.0}) {
    direct.middle_mm = {side * 58, 5, 600};
    behind.middle_mm = {-side * 65, 5, 680};
    const DetectionResult result = DetectBoard(PictureOf(board, {direct, behind}, options).view(),
                                               {}, board, {.look_in_mirror = true});
    ASSERT_EQ(result.boards.size(), 2U) << result.reason;
    EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, direct, options)), kTolerance_px);
    EXPECT_LT(WorstError(result.boards[1], TrueCorners(board, behind, options)), kTolerance_px);
  }
}

TEST(BoardDetectorTest, ACharucoBoardInAMirrorAloneIsKnownAsSuch) {
  const BoardSpec board = Board("charuco:7x5:25:19");
  const BoardPictureOptions options;
  const BoardPose pose = BoardPose::Turned(0.1, 0.3, 0.1).Reversed();
  const Image picture = PictureOf(board, pose, options);
  const DetectionResult direct = DetectBoard(picture.view(), {}, board);
  EXPECT_THAT(direct.boards, IsEmpty());
  const DetectionResult result = DetectBoard(picture.view(), {}, board, {.look_in_mirror = true});
  ASSERT_EQ(result.boards.size(), 1U) << result.reason;
  EXPECT_TRUE(result.boards[0].mirrored);
  EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, pose, options)), kTolerance_px);
}

TEST(BoardDetectorTest, PartOfACharucoBoardIsEnough) {
  const BoardSpec board = Board("charuco:9x7:25:19");
  const BoardPictureOptions options{.noise = kNoise};
  BoardPose pose = BoardPose::Turned(0.3, 0.2, 0.2);
  pose.middle_mm = {170, 110, 600};
  const DetectionResult result = DetectBoard(PictureOf(board, pose, options).view(), {}, board);
  ASSERT_EQ(result.boards.size(), 1U) << result.reason;
  EXPECT_GE(result.boards[0].corners.size(), 12U);
  EXPECT_LT(result.boards[0].corners.size(), 48U);
  EXPECT_TRUE(std::is_sorted(result.boards[0].corners.begin(), result.boards[0].corners.end()));
  EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, pose, options), 48), kTolerance_px);
}

TEST(BoardDetectorTest, SixteenBitsAndColourAreTheSameBoard) {
  const BoardSpec board = Board("chessboard:9x6:20");
  const BoardPose pose = BoardPose::Turned(0.2, -0.3, 0.1);
  // Dark: 12 bits in 16, of which the picture uses a quarter.
  const BoardPictureOptions dark{.exposure = 0.015, .quantized = false};
  const DetectionResult deep = DetectBoard(PictureOf(board, pose, dark).view(), {}, board);
  ASSERT_EQ(deep.boards.size(), 1U) << deep.reason;
  EXPECT_LT(WorstError(deep.boards[0], TrueCorners(board, pose, dark)), kTolerance_px);

  const BoardPictureOptions options;
  const Image gray = PictureOf(board, pose, options);
  Image colour(PixelFormat::kRgb8, gray.width, gray.height);
  for (std::size_t i = 0; i < gray.bytes.size(); ++i)
    std::fill_n(&colour.bytes[3 * i], 3, gray.bytes[i]);
  const DetectionResult result = DetectBoard(colour.view(), {}, board);
  ASSERT_EQ(result.boards.size(), 1U) << result.reason;
  EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, pose, options)), kTolerance_px);
}

TEST(BoardDetectorTest, FieldsAreMeasuredInThePicture) {
  const BoardSpec board = Board("chessboard:9x6:20");
  const BoardPose pose = BoardPose::Turned(0.2, -0.3, 0.1);
  const BoardPictureOptions options{.blur_px = 1.2};
  const Image frame = PictureOf(board, pose, options);
  for (const int parity : {0, 1}) {
    const ImageView field{frame.format, frame.width, frame.height / 2, 2L * frame.width,
                          frame.view().row(parity)};
    const PictureFromImage picture_from_field{.scale = {1, 2}, .offset_px = {0, parity}};
    const DetectionResult result = DetectBoard(field, picture_from_field, board);
    ASSERT_EQ(result.boards.size(), 1U) << result.reason;
    EXPECT_LT(WorstError(result.boards[0], TrueCorners(board, pose, options)), 0.15) << parity;
  }
}

TEST(BoardDetectorTest, QualityIsMeasured) {
  const BoardSpec board = Board("chessboard:9x6:20");
  const BoardPictureOptions options{.blur_px = 1.5};
  const DetectionResult result =
      DetectBoard(PictureOf(board, BoardPose(), options).view(), {}, board);
  ASSERT_EQ(result.boards.size(), 1U) << result.reason;
  const BoardQuality& quality = result.boards[0].quality;
  // 10 % to 90 % of a Gaussian, the pixels' own 1/12 px2 added.
  EXPECT_NEAR(quality.edge_px, 2.563 * std::sqrt(1.5 * 1.5 + 1.0 / 12), 0.1);
  EXPECT_NEAR(quality.contrast, 0.7, 0.01);
  EXPECT_EQ(quality.saturated, 0);
  EXPECT_NEAR(quality.spacing_px, 20 * 800.0 / 600, 0.1);
}

// Why there is no board, in words.
std::string ReasonFor(const BoardSpec& board, const Image& picture,
                      const DetectorOptions& options = {}) {
  const DetectionResult result = DetectBoard(picture.view(), {}, board, options);
  EXPECT_THAT(result.boards, IsEmpty());
  return result.reason;
}

TEST(BoardDetectorTest, OverexposedPicturesAreRefused) {
  for (const char* name : {"chessboard:9x6:20", "charuco:7x5:25:19"}) {
    const BoardSpec board = Board(name);
    const Image picture = PictureOf(board, BoardPose(), {.exposure = 1.5});
    EXPECT_THAT(ReasonFor(board, picture),
                HasSubstr("overexposed (100 % of the board's white saturated)"));
  }
}

TEST(BoardDetectorTest, BlurredPicturesAreRefused) {
  const BoardSpec board = Board("chessboard:9x6:20");
  const std::string reason = ReasonFor(board, PictureOf(board, BoardPose(), {.blur_px = 4.5}));
  EXPECT_THAT(reason, HasSubstr("too blurred (edges 11."));
}

TEST(BoardDetectorTest, AnotherBoardIsNotTakenForTheWantedOne) {
  const Image picture = PictureOf(Board("chessboard:8x5:20"), BoardPose::Turned(0.1, 0.2, 0), {});
  EXPECT_THAT(ReasonFor(Board("chessboard:9x6:20"), picture),
              HasSubstr("another number of corners: 8x5 seen, 9x6 wanted"));
  EXPECT_THAT(ReasonFor(Board("chessboard:6x5:20"), picture), HasSubstr("corners"));
  EXPECT_THAT(ReasonFor(Board("charuco:7x5:20:15"), picture),
              HasSubstr("no marker of DICT_5X5_250 is seen"));
  const Image other = PictureOf(Board("charuco:7x5:25:19:DICT_4X4_50"), BoardPose(), {});
  EXPECT_THAT(ReasonFor(Board("charuco:5x7:25:19:DICT_4X4_50"), other), HasSubstr("markers"));
}

TEST(BoardDetectorTest, TheLegacyPatternOfOpenCvIsRefused) {
  const BoardSpec board = Board("charuco:7x6:20:15");
  // Drawn by hand: markers in the white squares, of which the first one is at the top left.
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250);
  constexpr int kSquare_px = 60, kMarker_px = 45, kMargin_px = 60;
  cv::Mat page(kSquare_px * 6 + 2 * kMargin_px, kSquare_px * 7 + 2 * kMargin_px, CV_8UC1,
               cv::Scalar(230));
  int id = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 7; ++column) {
      const int x = kMargin_px + column * kSquare_px, y = kMargin_px + row * kSquare_px;
      if ((row + column) % 2 != 0) {
        page(cv::Rect(x, y, kSquare_px, kSquare_px)) = 20;
        continue;
      }
      cv::Mat marker;
      dictionary->drawMarker(id++, kMarker_px, marker);
      marker.copyTo(page(cv::Rect(x + 7, y + 7, kMarker_px, kMarker_px)));
    }
  Image picture(PixelFormat::kGray8, page.cols, page.rows);
  std::copy_n(page.data, picture.bytes.size(), picture.bytes.begin());
  EXPECT_THAT(ReasonFor(board, picture), HasSubstr("begins with a white square, as OpenCV before"));
}

TEST(BoardDetectorTest, TooLittleOfACharucoBoardIsRefusedWithTheCount) {
  const BoardSpec board = Board("charuco:9x7:25:19");
  BoardPose pose;
  pose.middle_mm = {325, 215, 600};
  EXPECT_THAT(ReasonFor(board, PictureOf(board, pose, {})), HasSubstr("only 1 of 31 markers"));
}

TEST(BoardDetectorTest, ThereIsNoBoardInNothing) {
  Image blank(PixelFormat::kGray8, 320, 240);
  Image noise = blank, tiny(PixelFormat::kGray8, 1, 1);
  RandomGenerator random(1, 1);
  for (std::uint8_t& byte : noise.bytes) byte = static_cast<std::uint8_t>(random.Index(256));
  for (const char* name : {"chessboard:9x6:20", "charuco:7x5:25:19"})
    for (const Image& picture : {blank, noise, tiny})
      EXPECT_THAT(ReasonFor(Board(name), picture, {.look_in_mirror = true}),
                  HasSubstr("no board found"));
}

TEST(BoardDetectorTest, OptionsThatMakeNoSenseAreRefused) {
  EXPECT_TRUE(CheckOptions(DetectorOptions()));
  EXPECT_FALSE(CheckOptions(DetectorOptions{.window_px = -1}));
  EXPECT_FALSE(CheckOptions(DetectorOptions{.max_edge_px = 0}));
  EXPECT_FALSE(CheckOptions(DetectorOptions{.max_saturated = NAN}));
}

}  // namespace
}  // namespace articap
