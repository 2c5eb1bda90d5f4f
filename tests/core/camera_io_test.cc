// SPDX-License-Identifier: MIT
#include "core/camera_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core.hpp>

#include "tests/core/camera_fixtures.h"
#include "tests/support/matchers.h"
#include "tests/support/report_figures.h"

namespace articap {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

CameraReading Read(const std::string& name, const CameraReadOptions& options = {}) {
  return OrThrow(ReadCameraFile(CameraFile(name), options));
}

TEST(CameraIoTest, FormatsAreToldApartByContent) {
  EXPECT_EQ(Read("calibration.toml").format, CameraFormat::kArticap);
  EXPECT_EQ(Read("aniposelib.toml").format, CameraFormat::kAniposelib);
  EXPECT_EQ(Read("camera_array.toml").format, CameraFormat::kCaliscope);
  EXPECT_EQ(Read("config.toml").format, CameraFormat::kCaliscope);
  EXPECT_EQ(Read("camera.yml").format, CameraFormat::kOpenCvYaml);
  EXPECT_EQ(Read("session.qca.txt").format, CameraFormat::kQualisys);
  EXPECT_EQ(OrThrow(ReadCameras(CameraFile("aniposelib.toml"))).cameras.size(), 2u);
}

TEST(CameraIoTest, AniposelibSaysNoUnit) {
  const CameraReading reading = Read("aniposelib.toml");
  EXPECT_THAT(reading.warnings, Contains(HasSubstr("taken as mm")));
  EXPECT_THAT(reading.warnings, Contains(HasSubstr("metadata.error")));
  EXPECT_EQ(reading.array.source, "aniposelib.toml, read as aniposelib");
  EXPECT_EQ(reading.array.cameras[1].cam_from_stage.translation_mm, Eigen::Vector3d(300, 0, 75));
  EXPECT_THAT(Read("aniposelib.toml", {.unit = "mm", .size = {}}).warnings,
              Not(Contains(HasSubstr("unit"))));
}

// The same cameras in metres, as FreeMoCap and Pose2Sim may have them: read as mm they would stand
// a third of a millimetre apart.
TEST(CameraIoTest, MetresTakenForMmAreRefused) {
  const std::string text =
      Replaced(TextOfCameraFile("aniposelib.toml"), "[ 300.0, 0.0, 75.0,]", "[ 0.3, 0.0, 0.075,]");
  EXPECT_THAT(RefusalOf(text), HasSubstr("0.3092 mm"));
  EXPECT_THAT(RefusalOf(text), HasSubstr("--unit m"));
  const auto reading = OrThrow(ParseCameras(text, "file", {.unit = "m", .size = {}}));
  EXPECT_THAT(reading.array.cameras[1].cam_from_stage.translation_mm,
              PointNear(Eigen::Vector3d(300, 0, 75), 1e-10));
  // Said by a user, the implausible is a warning.
  EXPECT_THAT(OrThrow(ParseCameras(text, "file", {.unit = "mm", .size = {}})).warnings,
              Contains(HasSubstr("all within 0.3092 mm")));
  EXPECT_THAT(
      OrThrow(ParseCameras(TextOfCameraFile("aniposelib.toml"), "file", {.unit = "m", .size = {}}))
          .warnings,
      Contains(HasSubstr("as far as 3.092e+05 mm")));
}

TEST(CameraIoTest, UnitsThatContradictTheFileAreRefused) {
  EXPECT_THAT(RefusalOf(TextOfCameraFile("calibration.toml"), {.unit = "m", .size = {}}),
              HasSubstr("in mm, not in m"));
  EXPECT_THAT(RefusalOf(TextOfCameraFile("camera_array.toml"), {.unit = "mm", .size = {}}),
              HasSubstr("in m, not in mm"));
  EXPECT_THAT(RefusalOf(TextOfCameraFile("aniposelib.toml"), {.unit = "ft", .size = {}}),
              HasSubstr("'ft'"));
}

TEST(CameraIoTest, CaliscopeIsInMetresAndMayHaveCamerasWithoutCalibration) {
  const CameraReading reading = Read("camera_array.toml");
  ASSERT_EQ(reading.array.cameras.size(), 2u);
  EXPECT_EQ(reading.array.cameras[0].name, "cam_0");
  EXPECT_EQ(reading.array.cameras[1].name, "cam_2");
  EXPECT_EQ(reading.array.cameras[0].cam_from_stage.translation_mm, Eigen::Vector3d(365, 425, 879));
  EXPECT_THAT(reading.warnings,
              ElementsAre(HasSubstr("'cam_1' is left out"), HasSubstr("'cam_2' is shown turned"),
                          HasSubstr("not taken over: error, grid_count")));
}

TEST(CameraIoTest, OlderCaliscopeHasRotationMatricesAndOtherTables) {
  const CameraReading reading = Read("config.toml");
  ASSERT_EQ(reading.array.cameras.size(), 1u);
  // A quarter turn about z, then 250, -125, 750 mm.
  EXPECT_THAT(reading.array.cameras[0].cam_from_stage * Eigen::Vector3d(10, 20, 30),
              PointNear(Eigen::Vector3d(230, -115, 780), 1e-12));
  EXPECT_THAT(reading.warnings, Contains(HasSubstr("CreationDate, charuco")));
}

TEST(CameraIoTest, CaliscopeRoundTripsKeepEveryByte) {
  CameraArray array = InventedCameras();
  array.cameras[0].cam_from_stage.translation_mm = {1.0 / 3, -1e-5, 12345.678901234567};
  const std::string text = WriteCaliscope(array);
  const auto reading = OrThrow(ParseCameras(text, "camera_array.toml"));
  EXPECT_EQ(WriteCaliscope(reading.array), text);
  // Rounded to 1e-9 mm, and to the digits that the double of the metres has.
  EXPECT_THAT(reading.array.cameras[0].cam_from_stage,
              Rigid3dNear(array.cameras[0].cam_from_stage, 1e-13, 1e-9));
  EXPECT_EQ(reading.array.cameras[1].lens, array.cameras[1].lens);
}

// Against what another library reads, digit for digit.
TEST(CameraIoTest, OpenCvReadsWhatIsWrittenForIt) {
  const CameraArray array = InventedCameras();
  for (const Camera& camera : array.cameras) {
    const std::string text = WriteOpenCvYaml(camera);
    const cv::FileStorage storage(
        text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    EXPECT_EQ(static_cast<std::string>(storage["camera_name"]), camera.name);
    EXPECT_EQ(static_cast<int>(storage["image_width"]), camera.width);
    EXPECT_EQ(static_cast<int>(storage["image_height"]), camera.height);
    cv::Mat matrix, distortion, translation;
    storage["camera_matrix"] >> matrix;
    storage["distortion_coefficients"] >> distortion;
    storage["tvec"] >> translation;
    EXPECT_EQ(matrix.at<double>(0, 0), camera.lens.fx_px);
    EXPECT_EQ(matrix.at<double>(1, 2), camera.lens.cy_px);
    ASSERT_GE(distortion.rows, 5);
    for (int i = 0; i < distortion.rows; ++i)
      EXPECT_EQ(distortion.at<double>(i), camera.lens.distortion[i]);
    EXPECT_EQ(translation.at<double>(2), camera.cam_from_stage.translation_mm.z());

    const auto reading = OrThrow(ParseCameras(text, "camera.yml"));
    ASSERT_EQ(reading.array.cameras.size(), 1u);
    EXPECT_EQ(WriteOpenCvYaml(reading.array.cameras[0]), text);
    EXPECT_THAT(reading.warnings, IsEmpty());
  }
}

// And what OpenCV writes, we read.
TEST(CameraIoTest, WhatOpenCvWritesIsRead) {
  cv::FileStorage storage(
      ".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  const double third = 1000.0 / 3;
  storage << "image_width" << 1280 << "image_height" << 1024 << "camera_matrix"
          << (cv::Mat_<double>(3, 3) << third, 0, 640.1, 0, 334, 512.2, 0, 0, 1)
          << "distortion_coefficients"
          << (cv::Mat_<float>(1, 14) << -0.25f, 1e-7f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
  const auto reading = OrThrow(ParseCameras(storage.releaseAndGetString(), "head.yml"));
  const Camera& camera = reading.array.cameras.at(0);
  EXPECT_EQ(camera.name, "head");
  EXPECT_EQ(camera.lens.fx_px, third);
  EXPECT_EQ(camera.lens.cx_px, 640.1);
  EXPECT_EQ(camera.lens.distortion[0], -0.25);
  EXPECT_NEAR(camera.lens.distortion[1], 1e-7, 1e-14);  // OpenCV writes eight digits of a float
}

TEST(CameraIoTest, OpenCvsSampleIsReadAndMoreInItIsPassedOver) {
  const Camera camera = Read("camera.yml").array.cameras.at(0);
  EXPECT_EQ(camera.name, "camera");
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_EQ(camera.lens.fx_px, 5.3591573396163199e+02);
  EXPECT_EQ(camera.lens.cy_px, 235.5);
  EXPECT_THAT(camera.lens.distortion,
              ElementsAre(-0.265625, -0.0390625, 0.00175, -0.00025, 0.234375, 0, 0, 0));
}

TEST(CameraIoTest, RosHasTheSameWithoutTags) {
  const std::string text =
      "image_width: 640\nimage_height: 480\ncamera_name: head\ncamera_matrix:\n  rows: 3\n"
      "  cols: 3\n  data: [500.5, 0, 320, 0, 501, 240, 0, 0, 1]\n"
      "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
      "  data: [-0.1, 0.01, 0, 0, 0]\n";
  const Camera camera = OrThrow(ParseCameras(text, "ros.yaml")).array.cameras.at(0);
  EXPECT_EQ(camera.name, "head");
  EXPECT_EQ(camera.lens.fx_px, 500.5);
  EXPECT_THAT(RefusalOf(Replaced(text, "plumb_bob", "equidistant")), HasSubstr("equidistant"));
}

// Debian's opencv-doc has the results of OpenCV's own samples.
TEST(CameraIoTest, FilesOfOpenCvsSamplesAreRead) {
  const std::filesystem::path folder = "/usr/share/doc/opencv-doc/examples/data";
  if (!std::filesystem::exists(folder / "left_intrinsics.yml"))
    GTEST_SKIP() << folder << " is not there; install opencv-doc to run this test";
  const Camera left = OrThrow(ReadCameras(folder / "left_intrinsics.yml")).cameras.at(0);
  EXPECT_EQ(left.lens.fx_px, 535.91573396163199);
  EXPECT_EQ(left.lens.distortion[Lens::kK3], 0.23839153080878486);
  EXPECT_EQ(left.width, 640);

  // The pair has neither a size nor, in the package, its extrinsics.
  const auto size_missing = ReadCameras(folder / "intrinsics.yml");
  ASSERT_FALSE(size_missing);
  EXPECT_THAT(size_missing.error().message, HasSubstr("--size"));
  const auto pose_missing = ReadCameras(folder / "intrinsics.yml", {.unit = {}, .size = "640x480"});
  ASSERT_FALSE(pose_missing);
  EXPECT_THAT(pose_missing.error().message, HasSubstr("extrinsics.yml"));
  const auto list = ReadCameras(folder / "calibration.yml");
  ASSERT_FALSE(list);
  EXPECT_THAT(list.error().message, HasSubstr("'camera_matrix' is missing"));

  const std::filesystem::path pair = MakeTemporaryFolder("articap_pair");
  std::filesystem::copy_file(folder / "intrinsics.yml", pair / "intrinsics.yml");
  ASSERT_TRUE(WriteFile(pair / "extrinsics.yml",
                        "%YAML:1.0\n---\nR: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                        "   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]\nT: !!opencv-matrix\n"
                        "   rows: 3\n   cols: 1\n   dt: d\n   data: [ -8.35e-02, 0., 1.e-03 ]\n"));
  const auto reading =
      OrThrow(ReadCameraFile(pair / "intrinsics.yml", {.unit = "m", .size = "640x480"}));
  ASSERT_EQ(reading.array.cameras.size(), 2u);
  EXPECT_EQ(reading.array.cameras[1].name, "right");
  EXPECT_EQ(reading.array.cameras[1].lens.cx_px, 334.55744527912015);
  EXPECT_THAT(reading.array.cameras[1].cam_from_stage,
              Rigid3dNear(Rigid3d{Eigen::Quaterniond::Identity(), {-83.5, 0, 1}}, 1e-15, 1e-12));
  std::filesystem::remove_all(pair);
}

// The first camera of the file stands at (1000, 0, 500) and looks along -x, upright (z is up): y of
// the stage is to its right. Its lens is without distortion on the axis.
TEST(CameraIoTest, QualisysCamerasSeeWhatStandsBeforeThem) {
  const CameraReading reading = Read("session.qca.txt");
  ASSERT_EQ(reading.array.cameras.size(), 2u);
  const Camera& camera = reading.array.cameras[0];
  EXPECT_EQ(camera.name, "10001");
  EXPECT_EQ(camera.width, 1920);
  EXPECT_EQ(camera.height, 1088);
  EXPECT_EQ(camera.lens.fx_px, 1500);
  EXPECT_EQ(camera.lens.fy_px, 1501);
  EXPECT_EQ(camera.lens.cx_px, 960);
  EXPECT_EQ(camera.lens.cy_px, 544);
  // Not in 1/64 px: the distortion has no unit.
  EXPECT_THAT(camera.lens.distortion, ElementsAre(-0.125, 0.0625, 0.001, -0.002, 0.03125, 0, 0, 0));
  EXPECT_THAT(camera.cam_from_stage * Eigen::Vector3d(0, 0, 500),
              PointNear(Eigen::Vector3d(0, 0, 1000), 1e-9));
  EXPECT_THAT(camera.cam_from_stage * Eigen::Vector3d(0, 100, 500),
              PointNear(Eigen::Vector3d(100, 0, 1000), 1e-9));
  EXPECT_THAT(camera.cam_from_stage * Eigen::Vector3d(0, 0, 600),
              PointNear(Eigen::Vector3d(0, -100, 1000), 1e-9));
  EXPECT_THAT(reading.warnings,
              ElementsAre(HasSubstr("'10002' is shown turned by 90 degrees"),
                          HasSubstr("'10003' is left out"), HasSubstr("half a pixel")));
}

// The second camera's video is a part of the sensor.
TEST(CameraIoTest, QualisysVideosMayBePartsOfTheSensor) {
  const Camera camera = Read("session.qca.txt").array.cameras.at(1);
  EXPECT_EQ(camera.width, 1600);
  EXPECT_EQ(camera.height, 1000);
  EXPECT_EQ(camera.lens.cx_px, 960 - 100);
  EXPECT_EQ(camera.lens.cy_px, 544 - 44);
}

TEST(CameraIoTest, OtherFilesLikeQualisysAreRefusedWithWords) {
  const std::string text = TextOfCameraFile("session.qca.txt");
  const auto refusal = [&](const std::string& what, const std::string& instead) {
    return RefusalOf(Replaced(text, what, instead));
  };
  // In whole pixels, as Theia has it, in other frames, too.
  EXPECT_THAT(refusal("122879.000000", "1920"), HasSubstr("another program"));
  EXPECT_THAT(refusal("2023.1 (build 1)", "none"), HasSubstr("Pose2Sim"));
  // Portrait pictures beside a landscape sensor.
  EXPECT_THAT(refusal("right=\"1919\" bottom=\"1087\"", "right=\"1087\" bottom=\"1919\""),
              HasSubstr("turned"));
  EXPECT_THAT(refusal("r11=\"0.000000\"", "r11=\"0.5\""), HasSubstr("not orthonormal"));
  EXPECT_THAT(refusal("r31=\"1.000000\"", "r31=\"-1.000000\""), HasSubstr("reflection"));
  EXPECT_THAT(refusal("r11=\"0.000000\"", ""), HasSubstr("'r11' of <transform>"));
  EXPECT_THAT(refusal("focalLengthU=\"96000.000000\"", "focalLengthU=\"nan\""),
              HasSubstr("'focalLengthU'"));
  EXPECT_THAT(refusal("skew=\"0.000000\"", "skew=\"64\""), HasSubstr("skew of 1 px"));
  EXPECT_THAT(refusal("10002", "10001"), HasSubstr("twice"));
  EXPECT_THAT(refusal("</calibration>", ""), HasSubstr("byte"));
  EXPECT_THAT(RefusalOf("<calibration/>"), HasSubstr("no cameras"));
  EXPECT_THAT(RefusalOf("<?xml version=\"1.0\"?><opencv_storage/>"), HasSubstr("YAML"));
}

TEST(CameraIoTest, HostileYamlIsRefusedWithWords) {
  const std::string text = TextOfCameraFile("camera.yml");
  const auto refusal = [&](const std::string& what, const std::string& instead) {
    return RefusalOf(Replaced(text, what, instead));
  };
  EXPECT_THAT(refusal("rows: 3", "rows: 4"), HasSubstr("file:10: 'camera_matrix'"));
  EXPECT_THAT(refusal("rows: 3", "rows: 2000000000"), HasSubstr("rows and columns"));
  EXPECT_THAT(refusal("rows: 3", "rows: -3"), HasSubstr("rows and columns"));
  EXPECT_THAT(refusal("5.3591573396163199e+02", "five"), HasSubstr("9 numbers"));
  EXPECT_THAT(refusal("5.3591573396163199e+02", ".Nan"), HasSubstr("9 numbers"));
  EXPECT_THAT(refusal("5.3591573396163199e+02", "1e999"), HasSubstr("not finite"));
  EXPECT_THAT(refusal("0., 0., 1. ]", "0., 0., 1."), HasSubstr("9 numbers"));
  EXPECT_THAT(refusal("0., 0., 1. ]", "0., 0., 1., 1. ]"), HasSubstr("9 numbers"));
  EXPECT_THAT(refusal("dt: d", "dt: \"2d\""), HasSubstr("dt: d"));
  EXPECT_THAT(refusal("image_width: 640", "image_height: 640"), HasSubstr("there twice"));
  EXPECT_THAT(refusal("image_width: 640", "image_width: wide"), HasSubstr("'image_width'"));
  EXPECT_THAT(refusal("image_width: 640", "image_width 640"), HasSubstr("file:4:"));
  EXPECT_THAT(refusal("flags: 0", "fisheye_model: 1"), HasSubstr("fisheye"));
  EXPECT_THAT(RefusalOf("%YAML:1.0\n---\n   rows: 3\n"), HasSubstr("without a name"));
  EXPECT_THAT(RefusalOf("%YAML:1.0\n---\n"), HasSubstr("'camera_matrix' is missing"));
}

TEST(CameraIoTest, ASizeIsForFilesThatHaveNone) {
  const std::string text =
      Replaced(Replaced(TextOfCameraFile("camera.yml"), "image_width: 640\n", ""),
               "image_height: 480\n", "");
  EXPECT_THAT(RefusalOf(text), HasSubstr("--size"));
  const auto reading = OrThrow(ParseCameras(text, "file", {.unit = {}, .size = "800x600"}));
  EXPECT_EQ(reading.array.cameras[0].width, 800);
  EXPECT_THAT(RefusalOf(TextOfCameraFile("camera.yml"), {.unit = {}, .size = "800x600"}),
              HasSubstr("640x480 px, not 800x600"));
  for (const char* size : {"800", "800x", "x600", "800x600x3", "800X600", "8x6", "-800x600"})
    EXPECT_THAT(RefusalOf(text, {.unit = {}, .size = size}), HasSubstr("as 640x480")) << size;
}

TEST(CameraIoTest, LossesAreNamed) {
  const CameraArray array = InventedCameras();
  EXPECT_THAT(LossesOf(array, CameraFormat::kArticap), ElementsAre(HasSubstr("five distortion")));
  EXPECT_THAT(LossesOf(array, CameraFormat::kOpenCvYaml),
              ElementsAre(HasSubstr("1 mirrors"), HasSubstr("standard deviations"),
                          HasSubstr("time offsets"), HasSubstr("invented, for a test")));
  EXPECT_THAT(LossesOf(array, CameraFormat::kCaliscope), Contains(HasSubstr("numbered")));
  EXPECT_THAT(LossesOf(Read("camera.yml").array, CameraFormat::kArticap), IsEmpty());
}

TEST(CameraIoTest, TheReportHasPlacesAndBaselines) {
  const StageReport report = DescribeCameras(Read("aniposelib.toml").array, "file");
  EXPECT_EQ(FigureOf(report, "cameras"), 2);
  EXPECT_NEAR(FigureOf(report, "baseline_mm"), std::hypot(300, 75), 1e-9);
  EXPECT_EQ(report.tables.at(0).rows.at(1).values.at(2), 810);
  EXPECT_THAT(DescribeCameras(InventedCameras(), "file").verdict,
              HasSubstr("2 cameras and 1 mirror in file"));
}

}  // namespace
}  // namespace articap
