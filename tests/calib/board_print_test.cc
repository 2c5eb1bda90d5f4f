// SPDX-License-Identifier: MIT
#include "calib/board_print.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "calib/board_detector.h"
#include "core/file_io.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::HasSubstr;

constexpr double kFine = 16;   // px/mm, to measure by
constexpr double kCoarse = 4;  // for the detector

BoardSpec Board(const char* name) { return ParseBoardSpec(name).value(); }

// The page as a printer would make it; empty where poppler's pdftoppm is not installed.
cv::Mat Rasterised(const std::string& pdf, double px_per_mm) {
  const std::filesystem::path folder = MakeTemporaryFolder("board_print_test");
  if (!WriteFile(folder / "board.pdf", pdf)) return {};
  const std::string command = "pdftoppm -gray -singlefile -r " + std::to_string(25.4 * px_per_mm) +
                              " " + (folder / "board.pdf").string() + " " +
                              (folder / "page").string();
  if (std::system(command.c_str()) != 0) return {};
  return cv::imread((folder / "page.pgm").string(), cv::IMREAD_GRAYSCALE);
}

DetectionResult Detect(const cv::Mat& page, const BoardSpec& board) {
  DetectorOptions options;
  options.max_saturated = 1;  // white paper
  const ImageView view{PixelFormat::kGray8, page.cols, page.rows,
                       static_cast<std::ptrdiff_t>(page.step), page.data};
  return DetectBoard(view, {}, board, options);
}

// Where a line of pixels changes between dark and white.
std::vector<int> ChangesAlong(const cv::Mat& line) {
  std::vector<int> changes;
  for (int i = 1; i < static_cast<int>(line.total()); ++i)
    if ((line.at<unsigned char>(i - 1) < 128) != (line.at<unsigned char>(i) < 128))
      changes.push_back(i);
  return changes;
}

// Through the middle of a row and of a column of squares.
void ExpectSquares(const cv::Mat& line, int squares, double square_mm) {
  const std::vector<int> changes = ChangesAlong(line);
  ASSERT_GE(static_cast<int>(changes.size()), squares);
  // The last one may lead from white to white paper.
  for (int i = 1; i < squares; ++i)
    EXPECT_NEAR((changes[i] - changes[0]) / kFine, i * square_mm, 0.1) << i;
}

TEST(BoardPrintTest, SquaresHaveTheirTrueSize) {
  for (const char* name : {"chessboard:9x6:25", "chessboard:6x9:7.3", "chessboard:11x8:13.7"}) {
    const BoardSpec board = Board(name);
    const cv::Mat page = Rasterised(OrThrow(BoardPdf(board)), kFine);
    if (page.empty()) GTEST_SKIP() << "pdftoppm, of poppler-utils, is not there";
    cv::Mat dark;
    cv::findNonZero(page < 128, dark);
    const cv::Point first = cv::boundingRect(dark).tl();
    const int half_px = static_cast<int>(kFine * board.square_mm / 2);
    ExpectSquares(page.row(first.y + half_px), board.square_columns(), board.square_mm);
    const cv::Mat column = page.col(first.x + half_px).clone();
    ExpectSquares(column.reshape(1, 1), board.square_rows(), board.square_mm);
  }
}

TEST(BoardPrintTest, WhatIsPrintedIsDetected) {
  for (const char* name :
       {"chessboard:9x6:25", "charuco:7x5:25:18", "charuco:5x8:20:15:DICT_4X4_50",
        "charuco:6x6:25:18:DICT_APRILTAG_36h11"}) {
    const BoardSpec board = Board(name);
    const cv::Mat page = Rasterised(OrThrow(BoardPdf(board, {.paper = Paper::kFitted})), kCoarse);
    if (page.empty()) GTEST_SKIP() << "pdftoppm, of poppler-utils, is not there";
    const DetectionResult result = Detect(page, board);
    ASSERT_EQ(result.boards.size(), 1U) << name << ": " << result.reason;
    const DetectedBoard& found = result.boards[0];
    ASSERT_EQ(static_cast<int>(found.corners.size()), board.num_corners()) << name;
    for (int corner = 1; corner < board.num_corners(); ++corner) {
      const Eigen::Vector2d measured_mm = (found.points_px[corner] - found.points_px[0]) / kCoarse;
      const Eigen::Vector2d true_mm = board.corner_in_board_mm(corner).head<2>();
      // Poppler moves edges to whole pixels.
      EXPECT_LT((measured_mm - true_mm).norm(), 1.5 / kCoarse) << name << ", corner " << corner;
    }
  }
}

TEST(BoardPrintTest, TheBarIs100MmLong) {
  const cv::Mat page = Rasterised(OrThrow(BoardPdf(Board("chessboard:9x6:20"))), kFine);
  if (page.empty()) GTEST_SKIP() << "pdftoppm, of poppler-utils, is not there";
  // The lowest dark row of the page is the bar.
  cv::Mat dark;
  cv::findNonZero(page < 128, dark);
  const int lowest = cv::boundingRect(dark).br().y - 1;
  cv::findNonZero(page.row(lowest) < 128, dark);
  EXPECT_NEAR(cv::boundingRect(dark).width / kFine, 100, 0.2);
}

TEST(BoardPrintTest, ThePageIsPaperUprightOrAcross) {
  const cv::Mat across = Rasterised(OrThrow(BoardPdf(Board("chessboard:9x6:25"))), kFine);
  if (across.empty()) GTEST_SKIP() << "pdftoppm, of poppler-utils, is not there";
  EXPECT_NEAR(across.cols / kFine, 297, 0.2);
  EXPECT_NEAR(across.rows / kFine, 210, 0.2);
  const cv::Mat upright = Rasterised(OrThrow(BoardPdf(Board("chessboard:6x9:25"))), kFine);
  EXPECT_NEAR(upright.cols / kFine, 210, 0.2);
  EXPECT_NEAR(upright.rows / kFine, 297, 0.2);
}

TEST(BoardPrintTest, TheSameBoardIsTheSameFile) {
  const BoardSpec board = Board("charuco:7x5:25:18");
  EXPECT_EQ(OrThrow(BoardPdf(board)), OrThrow(BoardPdf(board)));
  EXPECT_THAT(OrThrow(BoardPdf(board)), testing::Not(HasSubstr("CreationDate")));
}

TEST(BoardPrintTest, WhatDoesNotFitIsRefusedWithWhatWould) {
  const auto on_a4 = BoardPdf(Board("chessboard:9x6:30"));
  ASSERT_FALSE(on_a4);
  EXPECT_THAT(on_a4.error().message, HasSubstr("needs 324 x 247 mm of paper, more than A4"));
  EXPECT_THAT(on_a4.error().message, HasSubstr("print it on A3"));
  EXPECT_THAT(on_a4.error().message, HasSubstr("squares 25.2 mm at most"));
  EXPECT_TRUE(BoardPdf(Board("chessboard:9x6:25.2")));
  EXPECT_FALSE(BoardPdf(Board("chessboard:9x6:25.3")));
  EXPECT_TRUE(BoardPdf(Board("chessboard:9x6:30"), {.paper = Paper::kA3}));
  EXPECT_TRUE(BoardPdf(Board("chessboard:9x6:300"), {.paper = Paper::kFitted}));
  EXPECT_FALSE(BoardPdf(Board("chessboard:199x6:300"), {.paper = Paper::kFitted}));
}

}  // namespace
}  // namespace articap
