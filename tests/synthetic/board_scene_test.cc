// SPDX-License-Identifier: MIT
#include "synthetic/board_scene.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "tests/support/matchers.h"
#include "tests/support/result.h"

namespace articap {
namespace {

const CameraModel kSmall = {.width = 640, .height = 360, .focal_px = 900};
const BoardSpec kBoard = {.columns = 8, .rows = 5, .square_mm = 12};

BoardPoseOptions BesideTheMirror() {
  return {.center_in_stage_mm = {-10, 0, 10},
          .reach_mm = {30, 30, 40},
          .facing_in_stage = {1, 0, 1},
          .most_tilt_deg = 20,
          .whole_in_views = 2};
}

// Without noise, and blurred enough for a corner to have a shape.
cv::Mat SharpPicture(const Studio& studio, const Scene& scene, int camera) {
  SensorOptions sensor;
  sensor.format = PixelFormat::kGray16;
  sensor.noise = false;
  sensor.blur_px = 0.8;
  Image image = studio.Photograph(scene, camera, sensor, 1);
  cv::Mat grey;
  cv::Mat(image.height, image.width, CV_16UC1, image.bytes.data()).convertTo(grey, CV_32F);
  return grey;
}

struct CornerErrors {
  Eigen::Vector2d sum_px = Eigen::Vector2d::Zero();
  double sum_square_px2 = 0;
  double largest_px = 0;
  int count = 0;

  Eigen::Vector2d Mean() const { return sum_px / count; }
  double Rms() const { return std::sqrt(sum_square_px2 / count); }
};

// Distance to the nearest other corner.
double SpacingAt(const ViewTruth& truth, std::size_t corner) {
  double least_px = 1e9;
  for (std::size_t other = 0; other < truth.points_px.size(); ++other)
    if (other != corner)
      least_px = std::min(least_px, (truth.points_px[other] - truth.points_px[corner]).norm());
  return least_px;
}

void Measure(const cv::Mat& grey, const ViewTruth& truth, CornerErrors& errors) {
  for (std::size_t corner = 0; corner < truth.points_px.size(); ++corner) {
    const Eigen::Vector2d& true_px = truth.points_px[corner];
    std::vector<cv::Point2f> found = {
        {static_cast<float>(true_px.x() + 0.3), static_cast<float>(true_px.y() - 0.2)}};
    const int reach = std::max(2, static_cast<int>(0.35 * SpacingAt(truth, corner)));
    cv::cornerSubPix(grey, found, {reach, reach}, {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
    const Eigen::Vector2d error_px = Eigen::Vector2d(found[0].x, found[0].y) - true_px;
    errors.sum_px += error_px;
    errors.sum_square_px2 += error_px.squaredNorm();
    errors.largest_px = std::max(errors.largest_px, error_px.norm());
    ++errors.count;
  }
}

// Over several poses, what every view shows of the board is where the truth has it.
std::vector<CornerErrors> MeasureViews(const Studio& studio, const std::vector<Rigid3d>& poses) {
  const BoardPattern pattern = SquaresOf(kBoard);
  std::vector<CornerErrors> of_views(studio.cameras().array.views().size());
  for (const Rigid3d& pose : poses) {
    const std::vector<BoardTruth> truths = TruthOfBoard(studio, kBoard, pattern, pose);
    for (int camera = 0; camera < studio.num_cameras(); ++camera) {
      const cv::Mat grey = SharpPicture(studio, BoardScene(studio, pattern, pose), camera);
      for (std::size_t view = 0; view < truths.size(); ++view)
        if (truths[view].whole && truths[view].corners.view.camera == camera)
          Measure(grey, truths[view].corners, of_views[view]);
    }
  }
  return of_views;
}

// cornerSubPix itself scatters by 0.03 px on oblique corners, with however many samples; of 160 of
// them the mean has a standard error of 0.03 / sqrt(2 * 160) px an axis.
void ExpectUnbiased(const std::vector<CornerErrors>& of_views) {
  for (const CornerErrors& errors : of_views) {
    EXPECT_EQ(errors.count, 160);
    EXPECT_LT(errors.Mean().cwiseAbs().maxCoeff(), 4 * 0.03 / std::sqrt(2.0 * errors.count));
    EXPECT_LT(errors.Rms(), 0.05);
    EXPECT_LT(errors.largest_px, 0.15);
  }
}

TEST(BoardSceneTest, CornersAppearWhereTheTruthHasThem) {
  const Studio studio(RingOfCameras(1, 3));
  const auto poses = OrThrow(RandomBoardPoses(studio, kBoard, SquaresOf(kBoard), {}, 4, 5));
  ExpectUnbiased(MeasureViews(studio, poses));
}

TEST(BoardSceneTest, CornersInMirrorsAppearWhereTheTruthHasThemToo) {
  for (const double glass_mm : {0.0, 5.0}) {
    const Studio studio(MirrorSetUp(glass_mm, 3));
    const auto poses =
        OrThrow(RandomBoardPoses(studio, kBoard, SquaresOf(kBoard), BesideTheMirror(), 4, 5));
    ExpectUnbiased(MeasureViews(studio, poses));
  }
}

TEST(BoardSceneTest, BoardsAreHeldAsAsked) {
  const Studio studio(RingOfCameras(3, 1, kSmall));
  BoardPoseOptions options;
  options.whole_in_views = 2;
  const BoardPattern pattern = SquaresOf(kBoard);
  const auto poses = OrThrow(RandomBoardPoses(studio, kBoard, pattern, options, 20, 1));
  double most_tilt_deg = 0;
  for (const Rigid3d& pose : poses) {
    const Eigen::Vector3d middle_mm =
        pose * kBoard.corner_in_board_mm(39) / 2 + pose * Eigen::Vector3d::Zero() / 2;
    EXPECT_TRUE((middle_mm.cwiseAbs().array() <= options.reach_mm.array()).all());
    const double cosine = -(pose.rotation * Eigen::Vector3d::UnitZ()).z();
    most_tilt_deg = std::max(most_tilt_deg, std::acos(cosine) * 180 / std::numbers::pi);
    int whole = 0;
    for (const BoardTruth& truth : TruthOfBoard(studio, kBoard, pattern, pose))
      whole += truth.whole;
    EXPECT_GE(whole, 2);
  }
  EXPECT_LE(most_tilt_deg, 40);
  EXPECT_GT(most_tilt_deg, 30);
  const auto again = OrThrow(RandomBoardPoses(studio, kBoard, pattern, options, 20, 1));
  EXPECT_THAT(again[19], Rigid3dNear(poses[19], 0, 0));
}

TEST(BoardSceneTest, BoardsThatNobodyCanSeeAreRefused) {
  const Studio studio(RingOfCameras(2, 1, kSmall));
  BoardPoseOptions options;
  options.facing_in_stage = {0, 0, -1};
  const auto poses = RandomBoardPoses(studio, kBoard, SquaresOf(kBoard), options, 3, 1);
  ASSERT_FALSE(poses);
  EXPECT_THAT(poses.error().message, testing::HasSubstr("chessboard:8x5:12"));
}

// The middle of the board at a place, its front towards +x and +z alike.
Rigid3d FacingBoth(const Eigen::Vector3d& middle_mm) {
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitY()) * upright;
  return {rotation, middle_mm - rotation * (0.5 * kBoard.corner_in_board_mm(39))};
}

TEST(BoardSceneTest, WhatAMirrorsEdgeCutsOffIsNotVisible) {
  SyntheticCameras cameras = MirrorSetUp(0, 3, kSmall);
  cameras.outlines[0].width_mm = 30;
  const Studio studio(cameras);
  const auto truths = TruthOfBoard(studio, kBoard, SquaresOf(kBoard), FacingBoth({0, 0, 10}));
  ASSERT_EQ(truths.size(), 2u);
  EXPECT_TRUE(truths[0].whole) << "directly";
  EXPECT_TRUE(truths[0].corners.all_visible());
  EXPECT_FALSE(truths[1].whole) << "in the mirror";
  const auto visible =
      std::count(truths[1].corners.visible.begin(), truths[1].corners.visible.end(), true);
  EXPECT_GT(visible, 5);
  EXPECT_LT(visible, 35);
}

TEST(BoardSceneTest, BoardsHalfOutsideOrFromBehindAreNotWhole) {
  const Studio studio(MirrorSetUp(0, 3, kSmall));
  const BoardPattern pattern = SquaresOf(kBoard);
  const auto outside = TruthOfBoard(studio, kBoard, pattern, FacingBoth({0, 120, 10}));
  EXPECT_FALSE(outside[0].whole);
  const Rigid3d front = FacingBoth({0, 0, 10});
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()));
  const auto behind =
      TruthOfBoard(studio, kBoard, pattern, {turn * front.rotation, turn * front.translation_mm});
  for (const BoardTruth& truth : behind)
    EXPECT_EQ(std::count(truth.corners.visible.begin(), truth.corners.visible.end(), true), 0);
}

}  // namespace
}  // namespace articap
