// SPDX-License-Identifier: MIT
#include "calib/mirror_dots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/calib/network_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

// A face with dots that turns a little before a mirror.
std::vector<DotPair> SeeDots(const CameraArray& array, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  std::uniform_real_distribution<double> across(-50, 50), up(-70, 70), depth(-30, 30);
  std::vector<Eigen::Vector3d> face = {{-45, -40, 0}, {45, -40, 0}};
  for (int i = 0; i < 10; ++i) face.push_back({across(random), up(random), depth(random)});
  std::vector<DotPair> dots;
  for (int frame = 0; frame < 40; ++frame) {
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(0.5 + 0.2 * std::sin(0.3 * frame), Eigen::Vector3d::UnitY()));
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Eigen::Vector3d point = turn * face[i] + Eigen::Vector3d{-60, 0, 720};
      const auto direct = Project(array, {0, -1}, point);
      const auto mirrored = Project(array, {0, 0}, point);
      if (!direct || !mirrored) continue;
      dots.push_back({frame, "dot" + std::to_string(i),
                      *direct + Eigen::Vector2d{noise(random), noise(random)},
                      *mirrored + Eigen::Vector2d{noise(random), noise(random)}});
    }
  }
  return dots;
}

MirrorDotsOptions LengthOfNinety() {
  MirrorDotsOptions options;
  options.length_from = "dot0";
  options.length_to = "dot1";
  options.length_mm = 90;
  return options;
}

TEST(MirrorDotsTest, PerfectDotsAndLensGiveTheMirror) {
  const CameraArray array = MirrorScene(1, 1).array;
  const auto found =
      CalibrateMirrorFromDots(array.cameras[0], SeeDots(array, 0, 1), LengthOfNinety());
  ASSERT_TRUE(found) << found.error().message;
  const Mirror& mirror = found->output.array.mirrors[0];
  EXPECT_LT(mirror.normal_in_stage.cross(array.mirrors[0].normal_in_stage).norm(), 1e-7);
  EXPECT_GT(mirror.normal_in_stage.dot(array.mirrors[0].normal_in_stage), 0);
  EXPECT_NEAR(mirror.distance_mm, array.mirrors[0].distance_mm, 1e-4);
}

TEST(MirrorDotsTest, NoiseMovesTheMirrorAsFarAsItsSigmasSay) {
  const CameraArray array = MirrorScene(1, 1).array;
  MirrorDotsOptions options = LengthOfNinety();
  options.focal_sigma_percent = 0.01;  // the lens is right here
  options.length_sigma_mm = 0.001;
  double normal2 = 0, distance2 = 0;
  constexpr int kSeeds = 20;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const auto found =
        CalibrateMirrorFromDots(array.cameras[0], SeeDots(array, 0.2, seed), options);
    ASSERT_TRUE(found) << found.error().message;
    const Mirror& mirror = found->output.array.mirrors[0];
    // The sigma is that of the worse of two directions.
    normal2 += std::pow(mirror.normal_in_stage.cross(array.mirrors[0].normal_in_stage).norm() /
                            mirror.normal_sigma_rad,
                        2);
    distance2 +=
        std::pow((mirror.distance_mm - array.mirrors[0].distance_mm) / mirror.distance_sigma_mm, 2);
  }
  EXPECT_GT(normal2 / kSeeds, 0.4);
  EXPECT_LT(normal2 / kSeeds, 2.5);
  EXPECT_GT(distance2 / kSeeds, 0.3);
  EXPECT_LT(distance2 / kSeeds, 2.5);
  std::printf("normal %.2f, distance %.2f (squares over sigmas squared)\n", normal2 / kSeeds,
              distance2 / kSeeds);
}

TEST(MirrorDotsTest, ALensThatIsRoughlyKnownMakesLargerSigmas) {
  const CameraArray array = MirrorScene(1, 1).array;
  Camera rough = array.cameras[0];
  rough.lens.fx_px *= 1.03;
  rough.lens.fy_px *= 1.03;
  const auto found = CalibrateMirrorFromDots(rough, SeeDots(array, 0.2, 3), LengthOfNinety());
  ASSERT_TRUE(found) << found.error().message;
  const Mirror& mirror = found->output.array.mirrors[0];
  const double angle_rad = mirror.normal_in_stage.cross(array.mirrors[0].normal_in_stage).norm();
  EXPECT_LT(angle_rad, 2 * mirror.normal_sigma_rad);
  EXPECT_GT(mirror.normal_sigma_rad, 0.003);
  EXPECT_LT(std::abs(mirror.distance_mm - array.mirrors[0].distance_mm),
            2 * mirror.distance_sigma_mm);
}

TEST(MirrorDotsTest, OutliersDoNotTurnTheMirror) {
  const CameraArray array = MirrorScene(1, 1).array;
  std::vector<DotPair> dots = SeeDots(array, 0.2, 4);
  for (std::size_t i = 5; i < dots.size(); i += 25) dots[i].mirrored_px.y() += 30;
  const auto found = CalibrateMirrorFromDots(array.cameras[0], dots, LengthOfNinety());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(
      found->output.array.mirrors[0].normal_in_stage.cross(array.mirrors[0].normal_in_stage).norm(),
      0.005);
}

TEST(MirrorDotsTest, WhatCannotBeSolvedIsRefusedWithWords) {
  const CameraArray array = MirrorScene(1, 1).array;
  const std::vector<DotPair> dots = SeeDots(array, 0.2, 5);
  const auto message_of = [&](const std::vector<DotPair>& seen, const MirrorDotsOptions& options) {
    const auto found = CalibrateMirrorFromDots(array.cameras[0], seen, options);
    return found ? "" : found.error().message;
  };
  MirrorDotsOptions unknown = LengthOfNinety();
  unknown.length_to = "nose";
  EXPECT_THAT(message_of(dots, unknown), HasSubstr("both dot0 and nose"));
  EXPECT_THAT(message_of({dots.begin(), dots.begin() + 5}, LengthOfNinety()),
              HasSubstr("5 dots are seen both ways"));
  EXPECT_THAT(message_of(dots, {}), HasSubstr("length_mm"));
  std::vector<DotPair> exchanged = dots;
  for (DotPair& dot : exchanged) std::swap(dot.direct_px, dot.mirrored_px);
  EXPECT_THAT(message_of(exchanged, LengthOfNinety()), HasSubstr("exchanged"));
}

TEST(MirrorDotsTest, FilesAreReadWithTheLineOfTheirFaults) {
  const std::string header = "frame,marker,x_px,y_px,mirror_x_px,mirror_y_px\n";
  const auto dots = ParseDotPairs(header + "1,nose,10,20,30,40\n2,nose,11,21,,\n", "dots.csv");
  ASSERT_TRUE(dots) << dots.error().message;
  ASSERT_EQ(dots->size(), 1U);
  EXPECT_EQ((*dots)[0].mirrored_px, Eigen::Vector2d(30, 40));
  const auto message_of = [&](const std::string& rows) {
    const auto parsed = ParseDotPairs(rows, "dots.csv");
    return parsed ? "" : parsed.error().message;
  };
  EXPECT_THAT(message_of(header + "1,nose,x,20,30,40\n"), HasSubstr("dots.csv:2: x_px is 'x'"));
  EXPECT_THAT(message_of(header + "1,a,1,2,3,4\n1,a,1,2,3,4\n"), HasSubstr("dots.csv:3: dot 'a'"));
  EXPECT_THAT(message_of("a,b\n"), HasSubstr("frame,marker"));
}

}  // namespace
}  // namespace articap
