// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/board_finder.h"
#include "calib/lens_calibration.h"
#include "calib/rig_calibration.h"
#include "capture/pictures.h"

// Cameras calibrated from the chessboards of OpenCV's documentation, Debian's package opencv-doc: a
// stereo pair of 13 pictures each, whose squares are taken for 25 mm. The file that comes with
// them, left_intrinsics.yml, says fx 535.916 px at 0.39259 px RMS.
namespace articap {
namespace {

using testing::HasSubstr;

const std::filesystem::path kFolder = "/usr/share/doc/opencv-doc/examples/data";
const BoardSpec kBoard = ParseBoardSpec("chessboard:9x6:25").value();

std::vector<std::filesystem::path> PicturesOf(const std::string& side) {
  std::vector<std::filesystem::path> paths;
  for (const char* number :
       {"01", "02", "03", "04", "05", "06", "07", "08", "09", "11", "12", "13", "14"})
    paths.push_back(kFolder / (side + number + ".jpg"));
  return paths;
}

CameraSightings See(const std::string& side) {
  const auto source = OpenPictures(PicturesOf(side));
  const auto found = FindBoards(*source, kBoard);
  EXPECT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->set_aside.empty());
  CameraSightings camera{side, found->width, found->height, {}, {}};
  for (const FoundBoard& board : found->found) camera.sightings.push_back(board.sighting);
  return camera;
}

LensOptions PlainLeastSquares() {
  LensOptions options;
  options.huber_sigmas = 0;
  options.set_views_aside = false;
  return options;
}

class OpenCvCalibrationTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder / "right14.jpg"))
      GTEST_SKIP() << kFolder << ": opencv-doc is not installed";
  }
};

TEST_F(OpenCvCalibrationTest, EachLensByPlainLeastSquares) {
  const auto left = CalibrateLens(kBoard, See("left"), PlainLeastSquares());
  const auto right = CalibrateLens(kBoard, See("right"), PlainLeastSquares());
  ASSERT_TRUE(left && right);
  const Camera& camera = left->output.array.cameras[0];
  std::printf(
      "left %.4f px RMS, held out %.4f, fx %.2f +- %.2f px; right %.4f px RMS, fx %.2f +- "
      "%.2f px\n",
      left->output.rms_px(), left->output.held_out.rms_px, camera.lens.fx_px, camera.sigmas.fx_px,
      right->output.rms_px(), right->output.array.cameras[0].lens.fx_px,
      right->output.array.cameras[0].sigmas.fx_px);
  EXPECT_LE(left->output.rms_px(), 0.21);
  EXPECT_LE(right->output.rms_px(), 0.22);
  EXPECT_NEAR(camera.lens.fx_px, 532.8, 2);
  EXPECT_TRUE(left->report.IsUsable() && right->report.IsUsable());
}

TEST_F(OpenCvCalibrationTest, NoViewIsFlagged) {
  for (const char* side : {"left", "right"}) {
    const auto lens = CalibrateLens(kBoard, See(side), {});
    ASSERT_TRUE(lens) << lens.error().message;
    for (const SightingResult& sighting : lens->output.sightings)
      EXPECT_TRUE(sighting.used) << sighting.source << ": " << sighting.reason;
  }
}

TEST_F(OpenCvCalibrationTest, BothCamerasJointly) {
  RigOptions options;
  options.huber_sigmas = 0;
  options.set_views_aside = false;
  const auto rig = CalibrateRig(kBoard, {See("left"), See("right")}, PlainLeastSquares(), options);
  ASSERT_TRUE(rig) << rig.error().message;
  const double baseline_mm = rig->output.array.cameras[1].cam_from_stage.translation_mm.norm();
  std::printf("stereo %.4f px RMS, baseline %.3f mm, held-out rigidity %.3f mm, expected %.3f\n",
              rig->output.rms_px(), baseline_mm, rig->output.held_out.rigidity_mm,
              rig->output.held_out.expected_rigidity_mm);
  EXPECT_LE(rig->output.rms_px(), 0.23);
  EXPECT_NEAR(baseline_mm, 83.2, 0.3);
  EXPECT_TRUE(rig->report.IsUsable()) << rig->report.verdict;
}

// cv::cornerSubPix with its usual window, which is wider than the squares of left02 and drags its
// corners by several pixels. (The detector's own fit is not dragged, whatever its window.)
CameraSightings RefineByOpenCv(CameraSightings camera, int window_px) {
  for (BoardSighting& sighting : camera.sightings) {
    const cv::Mat picture = cv::imread((kFolder / sighting.source).string(), cv::IMREAD_GRAYSCALE);
    std::vector<cv::Point2f> points;
    for (const Eigen::Vector2d& point : sighting.points_px)
      points.emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()));
    cv::cornerSubPix(picture, points, {window_px, window_px}, {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4});
    for (std::size_t i = 0; i < points.size(); ++i)
      sighting.points_px[i] = {points[i].x, points[i].y};
  }
  return camera;
}

TEST_F(OpenCvCalibrationTest, CornersDraggedByTooWideAWindowAreNamed) {
  const CameraSightings left = See("left");
  const auto dragged = CalibrateLens(kBoard, RefineByOpenCv(left, 11), {});
  ASSERT_TRUE(dragged) << dragged.error().message;
  std::vector<std::string> named;
  for (const SightingResult& sighting : dragged->output.sightings)
    if (!sighting.used) named.push_back(sighting.source + ": " + sighting.reason);
  ASSERT_EQ(named.size(), 1U);
  std::printf("%s\n", named[0].c_str());
  EXPECT_THAT(named[0], HasSubstr("left02.jpg: "));
  EXPECT_THAT(named[0], HasSubstr("corner"));
  const auto fitting = CalibrateLens(kBoard, RefineByOpenCv(left, 5), {});
  ASSERT_TRUE(fitting);
  EXPECT_LE(fitting->output.rms_px(), 0.21);
  for (const SightingResult& sighting : fitting->output.sightings) EXPECT_TRUE(sighting.used);
}

TEST_F(OpenCvCalibrationTest, TheseViewsDoNotSupportTheRationalModel) {
  LensOptions options;
  options.model = LensModel::kRational;
  const auto lens = CalibrateLens(kBoard, See("left"), options);
  ASSERT_TRUE(lens) << lens.error().message;
  EXPECT_TRUE(lens->report.IsUsable());
  ASSERT_FALSE(lens->report.warnings.empty());
  std::printf("%s\n", lens->report.warnings[0].c_str());
  EXPECT_THAT(lens->report.warnings[0], HasSubstr("the rational model is refused"));
  EXPECT_EQ(lens->output.array.cameras[0].lens.distortion[Lens::kK4], 0);
  EXPECT_NEAR(lens->output.array.cameras[0].lens.fx_px, 532.8, 2);
}

}  // namespace
}  // namespace articap
