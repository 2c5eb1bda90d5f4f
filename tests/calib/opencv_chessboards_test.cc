// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "calib/board_detector.h"

// The chessboards of OpenCV's documentation, Debian's package opencv-doc: a stereo pair of cameras.
namespace articap {
namespace {

constexpr const char* kFolder = "/usr/share/doc/opencv-doc/examples/data/";

struct Calibration {
  double rms_px = 0;
  double fx_px = 0;
  std::vector<double> view_rms_px;  // of views 1 to 9, 11 to 14
};

std::vector<cv::Mat> Pictures(const std::string& side) {
  std::vector<cv::Mat> pictures;
  for (const char* number :
       {"01", "02", "03", "04", "05", "06", "07", "08", "09", "11", "12", "13", "14"})
    pictures.push_back(cv::imread(kFolder + side + number + ".jpg", cv::IMREAD_GRAYSCALE));
  return pictures;
}

bool HavePictures() { return std::filesystem::exists(std::string(kFolder) + "right14.jpg"); }

std::vector<DetectedBoard> DetectAll(const std::string& side, const DetectorOptions& options) {
  const BoardSpec board = ParseBoardSpec("chessboard:9x6:25").value();
  std::vector<DetectedBoard> found;
  for (const cv::Mat& picture : Pictures(side)) {
    const ImageView view{PixelFormat::kGray8, picture.cols, picture.rows,
                         static_cast<std::ptrdiff_t>(picture.step), picture.data};
    const DetectionResult result = DetectBoard(view, {}, board, options);
    EXPECT_EQ(result.boards.size(), 1U) << side << found.size() << ": " << result.reason;
    if (!result.boards.empty()) found.push_back(result.boards[0]);
  }
  return found;
}

// OpenCV's own calibration, with its five coefficients of distortion and no flags.
Calibration Calibrate(const std::vector<DetectedBoard>& views) {
  const BoardSpec board = ParseBoardSpec("chessboard:9x6:25").value();
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> points;
  for (const DetectedBoard& view : views) {
    boards.emplace_back();
    points.emplace_back();
    for (std::size_t i = 0; i < view.corners.size(); ++i) {
      const Eigen::Vector3f corner = board.corner_in_board_mm(view.corners[i]).cast<float>();
      const Eigen::Vector2f point = view.points_px[i].cast<float>();
      boards.back().emplace_back(corner.x(), corner.y(), corner.z());
      points.back().emplace_back(point.x(), point.y());
    }
  }
  cv::Mat camera, distortion, rotations, translations, sigmas, pose_sigmas, errors;
  Calibration calibration;
  calibration.rms_px = cv::calibrateCamera(boards, points, {640, 480}, camera, distortion,
                                           rotations, translations, sigmas, pose_sigmas, errors);
  calibration.fx_px = camera.at<double>(0, 0);
  for (int i = 0; i < errors.rows; ++i) calibration.view_rms_px.push_back(errors.at<double>(i));
  return calibration;
}

TEST(OpenCvChessboardsTest, AllAreFoundWholeAndFitALens) {
  if (!HavePictures()) GTEST_SKIP() << kFolder << ": opencv-doc is not installed";
  for (const char* side : {"left", "right"}) {
    const std::vector<DetectedBoard> views = DetectAll(side, {});
    ASSERT_EQ(views.size(), 13U);
    for (const DetectedBoard& view : views) EXPECT_EQ(view.corners.size(), 54U) << side;
    const Calibration calibration = Calibrate(views);
    // What the board's own flatness and print leave; by cornerSubPix it was 0.195 and 0.207.
    EXPECT_LT(calibration.rms_px, 0.17) << side;
    EXPECT_NEAR(calibration.fx_px, std::string(side) == "left" ? 533 : 537.5, 2);
    for (const double view_rms_px : calibration.view_rms_px) EXPECT_LT(view_rms_px, 0.25) << side;
  }
}

TEST(OpenCvChessboardsTest, AWindowThatReachesBeyondTheSquaresDoesNotDragCorners) {
  if (!HavePictures()) GTEST_SKIP() << kFolder << ": opencv-doc is not installed";
  DetectorOptions options;
  options.window_px = 11;  // the usual one, by which six corners of left02 were 2 to 6 px off
  const Calibration calibration = Calibrate(DetectAll("left", options));
  EXPECT_LT(calibration.rms_px, 0.18);
  EXPECT_LT(calibration.view_rms_px[1], 0.2);
}

// In the same order in both pictures of a pair: the cameras stand side by side, so that corners
// differ by nearly the same everywhere on the board.
TEST(OpenCvChessboardsTest, BothCamerasCountTheCornersAlike) {
  if (!HavePictures()) GTEST_SKIP() << kFolder << ": opencv-doc is not installed";
  const std::vector<DetectedBoard> left = DetectAll("left", {}), right = DetectAll("right", {});
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t view = 0; view < left.size(); ++view) {
    const Eigen::Vector2d left_row = left[view].points_px[8] - left[view].points_px[0];
    const Eigen::Vector2d right_row = right[view].points_px[8] - right[view].points_px[0];
    EXPECT_GT(left_row.normalized().dot(right_row.normalized()), 0.9) << view;
  }
}

}  // namespace
}  // namespace articap
