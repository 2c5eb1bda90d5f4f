// SPDX-License-Identifier: MIT
#include "core/calibration_toml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/toml_reader.h"
#include "tests/core/camera_fixtures.h"
#include "tests/support/matchers.h"

namespace articap {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(CalibrationTomlTest, TheGoldenFileIsReadAsItStands) {
  const CameraArray array = InventedCameras();
  ASSERT_EQ(array.cameras.size(), 2u);
  EXPECT_EQ(array.source, "invented, for a test");
  const Camera& left = array.cameras[0];
  EXPECT_EQ(left.name, "left");
  EXPECT_EQ(left.width, 1920);
  EXPECT_EQ(left.height, 1080);
  EXPECT_EQ(left.lens.fx_px, 2105.25);
  EXPECT_EQ(left.lens.fy_px, 2104.75);
  EXPECT_EQ(left.lens.cx_px, 961.5);
  EXPECT_EQ(left.lens.cy_px, 538.125);
  EXPECT_THAT(left.lens.distortion, ElementsAre(-0.1875, 0.0625, 0.001, -0.0005, 0, 0, 0, 0));
  // Half a turn about y; its rotation vector was rounded to 1e-13 rad.
  EXPECT_THAT(left.cam_from_stage * Eigen::Vector3d(10, 20, 30),
              PointNear(Eigen::Vector3d(-10, 32.5, 970), 1e-11));
  EXPECT_EQ(left.sigmas.cx_px, 1.25);
  EXPECT_EQ(left.sigmas.distortion[Lens::kK3], 0);
  EXPECT_TRUE(std::isnan(array.cameras[1].sigmas.fx_px));
  EXPECT_EQ(array.cameras[1].name, "right \"B\"");
  EXPECT_EQ(array.cameras[1].time_offset_s, -0.0125);
  EXPECT_EQ(array.cameras[1].lens.distortion[Lens::kK6], 1e-5);
  ASSERT_EQ(array.mirrors.size(), 1u);
  EXPECT_EQ(array.NameOf({0, 0}), "left/side");
  EXPECT_EQ(array.mirrors[0].normal_in_stage, Eigen::Vector3d(0.6, 0, 0.8));
  EXPECT_EQ(array.mirrors[0].distance_mm, 150.25);
  EXPECT_EQ(array.mirrors[0].distance_sigma_mm, 0.05);
}

TEST(CalibrationTomlTest, TheGoldenFileIsWrittenByteForByte) {
  EXPECT_EQ(WriteCalibration(InventedCameras()), TextOfCameraFile("calibration.toml"));
}

// Whatever the rotation, near a half turn included, where a vector and its opposite are the same.
TEST(CalibrationTomlTest, RoundTripsKeepEveryByteAndTheRotation) {
  // Three numbers, each rounded by half of 1e-13 rad at most, and what the sines leave.
  constexpr double kRounding_rad = 0.5e-13 * std::numbers::sqrt3 + 1e-14;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const std::vector<double> beside_pi = {0,      1e-15, -1e-15, 1e-13,   -1e-13, 5e-13,
                                         -5e-13, 1e-12, -1e-12, 1.1e-12, 1e-10,  -1e-10};
  for (int i = 0; i < 2000; ++i) {
    CameraArray array = InventedCameras();
    Eigen::Vector3d axis{normal(random), normal(random), normal(random)};
    if (i % 4 == 0) axis = Eigen::Vector3d::Unit(i / 4 % 3);
    const double angle = i % 2 == 0 ? std::numbers::pi + beside_pi[i / 2 % beside_pi.size()]
                                    : std::pow(10, -9 + i % 10);
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(angle, axis.normalized()));
    array.cameras[0].cam_from_stage = {
        rotation, {1e3 * normal(random), normal(random), 1e-6 * normal(random)}};
    const std::string text = WriteCalibration(array);
    const auto read = ParseCalibration(text, "calibration.toml");
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(WriteCalibration(*read), text);
    ASSERT_THAT(read->cameras[0].cam_from_stage,
                Rigid3dNear(array.cameras[0].cam_from_stage, kRounding_rad, 0));
  }
}

// aniposelib's CameraGroup.load() sorts the tables of the top level by name, takes all but
// [metadata] for cameras, and needs these keys of each; its newest version needs five
// coefficients.
TEST(CalibrationTomlTest, AniposelibFindsItsCamerasInTheirOrder) {
  CameraArray array = InventedCameras();
  array.cameras[1].lens.distortion[Lens::kK4] = 0;
  array.cameras[1].lens.distortion[Lens::kK5] = 0;
  array.cameras[1].lens.distortion[Lens::kK6] = 0;
  while (array.cameras.size() < 12) {
    array.cameras.push_back(array.cameras[1]);
    array.cameras.back().name = "camera " + std::to_string(array.cameras.size());
  }
  const toml::table document = OrThrow(ParseToml(WriteCalibration(array), "calibration.toml"));
  std::vector<std::string> names;
  for (const auto& [key, node] : document) {  // toml::table is sorted by its keys
    if (key.str() == "metadata") continue;
    ASSERT_TRUE(node.is_table()) << key.str();
    const toml::table& camera = *node.as_table();
    names.push_back(camera["name"].value_or(std::string()));
    EXPECT_EQ(camera["fisheye"].value<bool>(), false);
    EXPECT_EQ(camera["size"].as_array()->size(), 2u);
    EXPECT_EQ(camera["matrix"].as_array()->size(), 3u);
    EXPECT_EQ(camera["distortions"].as_array()->size(), 5u);
    EXPECT_EQ(camera["rotation"].as_array()->size(), 3u);
    EXPECT_EQ(camera["translation"].as_array()->size(), 3u);
    // Its TOML reader refuses lists of integers and floats together.
    for (const char* list : {"distortions", "rotation", "translation"})
      EXPECT_TRUE(camera[list].as_array()->is_homogeneous<double>()) << list;
  }
  std::vector<std::string> expected;
  for (const Camera& camera : array.cameras) expected.push_back(camera.name);
  EXPECT_EQ(names, expected);
}

TEST(CalibrationTomlTest, WhatItCannotBeIsRefusedWithWords) {
  const std::string text = TextOfCameraFile("calibration.toml");
  const auto refusal = [&](const std::string& what, const std::string& instead) {
    return RefusalOf(Replaced(text, what, instead));
  };
  EXPECT_THAT(refusal("2105.25", "nan"), HasSubstr("not finite"));
  EXPECT_THAT(refusal("2105.25", "inf"), HasSubstr("not finite"));
  EXPECT_THAT(refusal("2105.25", "-2105.25"), HasSubstr("not positive"));
  EXPECT_THAT(refusal("2105.25", "0.0"), HasSubstr("not positive"));
  EXPECT_THAT(refusal("2105.25", "12.0"), HasSubstr("are they in mm?"));
  EXPECT_THAT(refusal("2105.25, 0.0,", "2105.25, 0.5,"), HasSubstr("skew of 0.5 px"));
  EXPECT_THAT(refusal("[[2105.25, 0.0, 961.5], [0.0, 2104.75, 538.125], [0.0, 0.0, 1.0]]",
                      "[[2105.25, 0.0, 0.0], [0.0, 2104.75, 0.0], [961.5, 538.125, 1.0]]"),
              HasSubstr("transposed"));
  EXPECT_THAT(refusal("[0.0, 2104.75, 538.125]", "[0.0, 2104.75]"), HasSubstr("three rows"));
  EXPECT_THAT(refusal("[1920, 1080]", "[1920, 1080, 3]"), HasSubstr("size"));
  EXPECT_THAT(refusal("[1920, 1080]", "[1920, -1080]"), HasSubstr("no size of a picture"));
  EXPECT_THAT(refusal("[1920, 1080]", "[1920, 1080000]"), HasSubstr("no size of a picture"));
  EXPECT_THAT(refusal("[1920, 1080]", "[1920.5, 1080]"), HasSubstr("no size of a picture"));
  EXPECT_THAT(refusal("\"right \\\"B\\\"\"", "\"left\""),
              HasSubstr("'left': the name is there twice"));
  EXPECT_THAT(refusal("right \\\"B\\\"", "a/b"), HasSubstr("without a slash"));
  EXPECT_THAT(refusal("right \\\"B\\\"", ""), HasSubstr("no name"));
  EXPECT_THAT(refusal("camera = \"left\"", "camera = \"middle\""),
              HasSubstr("there is no camera 'middle'"));
  EXPECT_THAT(refusal("[0.6, 0.0, 0.8]", "[0.6, 0.6, 0.8]"), HasSubstr("not one long"));
  EXPECT_THAT(refusal("glass_index = 1.52", "glass_index = 0.5"), HasSubstr("refractive index"));
  EXPECT_THAT(refusal("glass_mm = 3.0", "glass_mm = -3.0"), HasSubstr("glass of -3 mm"));
  EXPECT_THAT(refusal("fx_px = 0.75", "fx_px = -0.75"), HasSubstr("negative"));
  EXPECT_THAT(refusal("fx_px = 0.75", "f_px = 0.75"), HasSubstr("'f_px' is no known sigma"));
  EXPECT_THAT(refusal("time_offset_s", "offset_s"), HasSubstr("'offset_s'"));
  EXPECT_THAT(refusal("fisheye = false", "fisheye = true"), HasSubstr("fisheye"));
  EXPECT_THAT(refusal("-0.0005, 0.0]", "-0.0005, 0.0, 0.0]"), HasSubstr("6 distortion"));
  EXPECT_THAT(refusal("0.004, 1e-05]", "0.004, 1e-05, 0.0, 0.5, 0.0, 0.0]"),
              HasSubstr("thin prism"));
  EXPECT_THAT(refusal("[0.0, 3.1415926535898, 0.0]", "[0.0, 180.0, 0.0]"), HasSubstr("degrees"));
  EXPECT_THAT(refusal("[0.0, 12.5, 1000.0]", "[0.0, 12.5, 1e9]"), HasSubstr("kilometre"));
  EXPECT_THAT(refusal("articap 1", "articap 2"), HasSubstr("newer"));
  EXPECT_THAT(refusal("unit = \"mm\"", "unit = \"inch\""), HasSubstr("'inch'"));
  EXPECT_THAT(refusal("unit = \"mm\"", "unit = 1"), HasSubstr("unit"));
  EXPECT_THAT(refusal("[cam_1]", "[cam_1"), HasSubstr("file, line 38"));
}

TEST(CalibrationTomlTest, FilesWithoutCamerasAreRefused) {
  EXPECT_THAT(RefusalOf(""), HasSubstr("nothing in it"));
  EXPECT_THAT(RefusalOf("# only a comment\n"), HasSubstr("nothing in it"));
  EXPECT_THAT(RefusalOf("[metadata]\nadjusted = true\n"), HasSubstr("no cameras"));
  EXPECT_THAT(RefusalOf("cameras = 3\n"), HasSubstr("no cameras"));
  EXPECT_THAT(RefusalOf("[cameras]\n"), HasSubstr("no cameras"));
}

// Zeros behind the eighth coefficient are no thin prism; a matrix may be written in integers.
TEST(CalibrationTomlTest, LongerListsOfZerosAndIntegersAreRead) {
  std::string text = TextOfCameraFile("calibration.toml");
  text = Replaced(text, "0.004, 1e-05]", "0.004, 1e-05, 0, 0, 0, 0, 0, 0]");
  text = Replaced(text, "[0.0, 0.0, 1.0]", "[0, 0, 1]");
  const auto read = ParseCalibration(text, "file");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(WriteCalibration(*read), TextOfCameraFile("calibration.toml"));
}

// A bundle adjustment that does not determine a value may say that its sigma is infinite.
TEST(CalibrationTomlTest, SigmasThatAreNotFiniteAreLeftOut) {
  CameraArray array = InventedCameras();
  array.cameras[0].sigmas.fx_px = HUGE_VAL;
  array.mirrors[0].distance_sigma_mm = HUGE_VAL;
  const CameraArray read = OrThrow(ParseCalibration(WriteCalibration(array), "file"));
  EXPECT_TRUE(std::isnan(read.cameras[0].sigmas.fx_px));
  EXPECT_EQ(read.cameras[0].sigmas.fy_px, 0.75);
  EXPECT_TRUE(std::isnan(read.mirrors[0].distance_sigma_mm));
  EXPECT_EQ(read.mirrors[0].normal_sigma_rad, 0.0002);
}

// Typed by hand with few digits, a normal is made one long; but not one that is something else.
TEST(CalibrationTomlTest, NormalsOfMirrorsAreNormalized) {
  const auto read = ParseCalibration(
      Replaced(TextOfCameraFile("calibration.toml"), "[0.6, 0.0, 0.8]", "[0.7071, 0.0, -0.7071]"),
      "file");
  ASSERT_TRUE(read) << read.error().message;
  const double half = std::numbers::sqrt2 / 2;
  EXPECT_THAT(read->mirrors[0].normal_in_stage, PointNear(Eigen::Vector3d(half, 0, -half), 1e-15));
  const std::string text = WriteCalibration(*read);
  EXPECT_EQ(WriteCalibration(OrThrow(ParseCalibration(text, "file"))), text);
}

}  // namespace
}  // namespace articap
