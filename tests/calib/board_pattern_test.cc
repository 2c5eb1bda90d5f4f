// SPDX-License-Identifier: MIT
#include "calib/board_pattern.h"

#include <gmock/gmock.h>

#include <cmath>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/core.hpp>
#include <string>

#include "tests/support/result.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr int kSquare_px =
    100;  // ten pixels a cell, of markers with 5 x 5 bits in 7/10 of a square

cv::Mat Drawn(const BoardSpec& board) {
  const BoardPattern pattern = OrThrow(PatternOf(board));
  cv::Mat drawn(kSquare_px * board.rows, kSquare_px * board.columns, CV_8UC1, cv::Scalar(255));
  const auto pixel = [&](double board_mm) {
    return static_cast<int>(std::lround(kSquare_px * (board_mm / board.square_mm + 1)));
  };
  for (const BoardRectangle& dark : pattern.dark)
    drawn(cv::Range(pixel(dark.min_mm.y()), pixel(dark.max_mm.y())),
          cv::Range(pixel(dark.min_mm.x()), pixel(dark.max_mm.x()))) = 0;
  return drawn;
}

cv::Mat DrawnByOpenCv(const BoardSpec& board) {
  const auto charuco = cv::aruco::CharucoBoard::create(
      board.columns, board.rows, static_cast<float>(board.square_mm),
      static_cast<float>(board.marker_mm),
      cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250));
  cv::Mat drawn;
  charuco->draw({kSquare_px * board.columns, kSquare_px * board.rows}, drawn);
  return drawn;
}

TEST(BoardPatternTest, CharucoBoardsAreThoseOfOpenCv) {
  for (const char* name : {"charuco:7x5:10:7", "charuco:6x8:10:7", "charuco:7x6:10:7"}) {
    const BoardSpec board = ParseBoardSpec(name).value();
    cv::Mat difference;
    cv::absdiff(Drawn(board), DrawnByOpenCv(board), difference);
    // OpenCV rounds each marker's place to a pixel of its own.
    const double part = cv::countNonZero(difference) / static_cast<double>(difference.total());
    EXPECT_LT(part, 0.02) << name;
  }
}

TEST(BoardPatternTest, TheMarkersOfTheDefaultDictionaryAreInTheWhiteSquares) {
  const BoardSpec board = ParseBoardSpec("charuco:7x5:12:9").value();
  const BoardPattern squares = SquaresOf(board);
  const BoardPattern pattern = OrThrow(PatternOf(board));
  ASSERT_GT(pattern.dark.size(), squares.dark.size());
  for (std::size_t i = squares.dark.size(); i < pattern.dark.size(); ++i) {
    const Eigen::Vector2d middle_mm = (pattern.dark[i].min_mm + pattern.dark[i].max_mm) / 2;
    const Eigen::Vector2d square = (middle_mm / board.square_mm).array().floor();
    EXPECT_EQ(std::abs(std::fmod(square.sum(), 2)), 1) << square.transpose();
  }
}

TEST(BoardPatternTest, AnUnknownDictionaryIsAnsweredWithTheKnownOnes) {
  const auto pattern = PatternOf(ParseBoardSpec("charuco:7x5:12:9:DICT_5X5").value());
  ASSERT_FALSE(pattern);
  EXPECT_THAT(pattern.error().message, HasSubstr("'DICT_5X5' is no dictionary"));
  EXPECT_THAT(pattern.error().message, HasSubstr("DICT_APRILTAG_36h11"));
}

TEST(BoardPatternTest, ADictionaryWithTooFewMarkersIsAnsweredWithThoseThatHaveEnough) {
  const auto pattern = PatternOf(ParseBoardSpec("charuco:12x11:12:9:DICT_4X4_50").value());
  ASSERT_FALSE(pattern);
  EXPECT_THAT(pattern.error().message, HasSubstr("66 markers, and DICT_4X4_50 only 50"));
  EXPECT_THAT(pattern.error().message, HasSubstr("DICT_4X4_100"));
  EXPECT_THAT(pattern.error().message, Not(HasSubstr("DICT_5X5_50")));
}

}  // namespace
}  // namespace articap
