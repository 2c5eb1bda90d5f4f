// SPDX-License-Identifier: MIT
#include "calib/nominal_mirror.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "calib/cost_functions/mirror_direction_cost.h"
#include "tests/support/result.h"

namespace articap {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFocal_px = 1500;
constexpr double kDotDiameter_mm = 4;

// A pinhole without distortion and an upright mirror, as the nominal ones are.
CameraArray TrueArray(double angle_deg, double side) {
  CameraArray array = UnknownMirror("front", 1280, 720);
  array.cameras[0].lens = CentredLens(kFocal_px, 1280, 720);
  const NominalParameters parameters = {std::log(kFocal_px), angle_deg * kDegree, 0.01};
  array.mirrors[0].normal_in_stage = NominalNormal(parameters.data(), side);
  // So that a face to one side of the axis is seen in the mirror on the other.
  array.mirrors[0].distance_mm =
      array.mirrors[0].normal_in_stage.dot(Eigen::Vector3d(side * 110, 0, 640));
  return array;
}

// Seven dots of a face that moves a little; the last one is hidden from the mirror.
std::vector<Eigen::Vector3d> FaceAt(int frame, double side) {
  const Eigen::Vector3d middle(-side * 70 + std::sin(0.2 * frame), 3 + 2 * std::cos(0.1 * frame),
                               620 + 2 * std::sin(0.15 * frame));
  const double jaw_mm = 5 * (1 - std::cos(0.4 * frame));
  return {
      middle + Eigen::Vector3d(0, -20, -20),        middle + Eigen::Vector3d(2, 10, -8),
      middle + Eigen::Vector3d(0, 25 + jaw_mm, -6), middle + Eigen::Vector3d(1, 52 + jaw_mm, 2),
      middle + Eigen::Vector3d(side * 25, 17, 5),   middle + Eigen::Vector3d(side * 40, -31, 18),
      middle + Eigen::Vector3d(-side * 25, 16, 5)};
}

Dot DotAt(const Eigen::Vector2d& center_px, double diameter_px) {
  Dot dot;
  dot.center_px = center_px;
  dot.covariance_px2 = 1e-4 * Eigen::Matrix2d::Identity();
  dot.shape_px2 = diameter_px * diameter_px / 4 * Eigen::Matrix2d::Identity();
  return dot;
}

DotVideo Film(const CameraArray& array, double side, double noise_px, int num_frames = 60) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, noise_px);
  DotVideo video{.camera = "front", .width = 1280, .height = 720};
  for (int frame = 0; frame < num_frames; ++frame) {
    DotPicture& picture = video.pictures.emplace_back();
    const std::vector<Eigen::Vector3d> face = FaceAt(frame, side);
    for (std::size_t i = 0; i < face.size(); ++i)
      for (const View& view : array.views()) {
        if (view.mirror >= 0 && i + 1 == face.size()) continue;
        const Eigen::Vector3d seen = view.mirror < 0 ? face[i] : array.mirrors[0].Reflect(face[i]);
        const auto place = Project(array, view, face[i]);
        if (!place) throw std::runtime_error("the scene is not in the picture");
        // As large as a disc that faces the camera.
        picture.dots.push_back(DotAt(*place + Eigen::Vector2d(noise(random), noise(random)),
                                     kFocal_px * kDotDiameter_mm / seen.z()));
      }
  }
  return video;
}

NominalMirrorOptions OptionsFor(MirrorSide side, double angle_deg) {
  NominalMirrorOptions options;
  options.mirror_side = side;
  options.mirror_angle_deg = angle_deg;
  options.mirror_angle_sigma_deg = 0.01;
  return options;
}

Result<NominalMirror> Estimate(const DotVideo& video, const NominalMirrorOptions& options) {
  return EstimateNominalMirror(video, UnknownMirror("front", 1280, 720),
                               {.dot_diameter_mm = kDotDiameter_mm}, options);
}

std::string RefusalOf(const DotVideo& video, const NominalMirrorOptions& options) {
  const auto found = Estimate(video, options);
  return found ? "" : found.error().message;
}

TEST(MirrorDirectionCostTest, ItsDerivativesAreThoseOfDifferences) {
  const std::unique_ptr<ceres::CostFunction> cost(
      MirrorDirectionCost::Create({-300, 150}, {310, 104}, -1, 0.3));
  const NominalParameters at = {std::log(kFocal_px), 0.8, 0.02};
  const double* const block = at.data();
  double residual = 0;
  Eigen::RowVector3d slope;
  double* row = slope.data();
  ASSERT_TRUE(cost->Evaluate(&block, &residual, &row));
  constexpr double kStep = 1e-5;
  for (int i = 0; i < kNumNominal; ++i) {
    std::array<double, 2> beside{};
    for (int way : {0, 1}) {
      NominalParameters moved = at;
      moved[i] += way == 0 ? -kStep : kStep;
      const double* const other = moved.data();
      ASSERT_TRUE(cost->Evaluate(&other, &beside[way], nullptr));
    }
    EXPECT_NEAR(slope[i], (beside[1] - beside[0]) / (2 * kStep), 1e-5 * (1 + std::abs(slope[i])));
  }
}

// What a point and its reflection are is a residual of nothing.
TEST(MirrorDirectionCostTest, APointAndItsReflectionLieInOnePlaneWithTheNormal) {
  const CameraArray array = TrueArray(45, 1);
  const Eigen::Vector2d middle_px(639.5, 359.5);
  const NominalParameters truth = {std::log(kFocal_px), 45 * kDegree, 0.01};
  for (const Eigen::Vector3d& point : FaceAt(3, 1)) {
    double residual_px = 1;
    MirrorDirectionCost{*Project(array, {0, -1}, point) - middle_px,
                        *Project(array, {0, 0}, point) - middle_px, 1,
                        1}(truth.data(), &residual_px);
    EXPECT_NEAR(residual_px, 0, 1e-9);
  }
}

TEST(NominalMirrorTest, PerfectDotsAndAKnownAngleGiveAllOfIt) {
  for (const auto& [side, sign] : {std::pair{MirrorSide::kRight, 1.0}, {MirrorSide::kLeft, -1.0}})
    for (const double angle_deg : {45.0, 52.0}) {
      const CameraArray truth = TrueArray(angle_deg, sign);
      const NominalMirror found =
          OrThrow(Estimate(Film(truth, sign, 0), OptionsFor(side, angle_deg)));
      // What is usually so draws it a little, as far as the dots leave it open.
      EXPECT_NEAR(found.array.cameras[0].lens.fx_px, kFocal_px, found.focal_sigma * kFocal_px);
      EXPECT_LT(found.focal_sigma, 0.02);
      EXPECT_GT(found.array.mirrors[0].normal_in_stage.dot(truth.mirrors[0].normal_in_stage),
                std::cos(0.3 * kDegree));
      EXPECT_NEAR(found.array.mirrors[0].distance_mm, truth.mirrors[0].distance_mm,
                  found.scale_sigma * truth.mirrors[0].distance_mm);
      EXPECT_EQ(found.pairs, 60 * 6);
    }
}

TEST(NominalMirrorTest, AKnownLensTellsTheAngle) {
  const CameraArray truth = TrueArray(50, 1);
  NominalMirrorOptions options = OptionsFor(MirrorSide::kRight, 45);
  options.mirror_angle_sigma_deg = 20;
  options.focal_px = kFocal_px;
  const NominalMirror found = OrThrow(Estimate(Film(truth, 1, 0.05), options));
  EXPECT_NEAR(found.angle_rad, 50 * kDegree, found.angle_sigma_rad);
  EXPECT_LT(found.angle_sigma_rad, 2 * kDegree);
}

TEST(NominalMirrorTest, ADrawnRegionTellsTheSideAndFalseDotsDoNotMatter) {
  const CameraArray truth = TrueArray(45, -1);
  DotVideo video = Film(truth, -1, 0.05);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(0, 1279), down(0, 719);
  for (DotPicture& picture : video.pictures)
    for (int i = 0; i < 4; ++i) picture.dots.push_back(DotAt({across(random), down(random)}, 9));
  EXPECT_THAT(RefusalOf(video, OptionsFor(MirrorSide::kLeft, 45)),
              HasSubstr("Draw its region, as --view-regions front/mirror=640x720+0+0"));
  CameraArray drawn = UnknownMirror("front", 1280, 720);
  drawn.mirrors[0].region = PictureRegion{0, 0, 640, 720};
  const NominalMirror found = OrThrow(EstimateNominalMirror(
      video, drawn, {.dot_diameter_mm = kDotDiameter_mm}, OptionsFor(MirrorSide::kByRegion, 45)));
  EXPECT_LT(found.array.mirrors[0].normal_in_stage.x(), 0);
  EXPECT_NEAR(found.array.cameras[0].lens.fx_px, kFocal_px, 2 * found.focal_sigma * kFocal_px);
}

TEST(NominalMirrorTest, AllLengthsAreScaledTogether) {
  const CameraArray truth = TrueArray(45, 1);
  NominalMirror found = OrThrow(Estimate(Film(truth, 1, 0.05), OptionsFor(MirrorSide::kRight, 45)));
  const double before_mm = found.array.mirrors[0].distance_mm;
  found.Rescale(1.25, 0.02);
  EXPECT_DOUBLE_EQ(found.array.mirrors[0].distance_mm, 1.25 * before_mm);
  EXPECT_DOUBLE_EQ(found.array.mirrors[0].distance_sigma_mm, 0.02 * 1.25 * before_mm);
  EXPECT_EQ(found.scale_sigma, 0.02);
}

TEST(NominalMirrorTest, WithoutADiameterTheFaceIsAsLargeAsFacesAre) {
  const DotVideo video = Film(TrueArray(45, 1), 1, 0.05);
  const NominalMirror found = OrThrow(EstimateNominalMirror(
      video, UnknownMirror("front", 1280, 720), {.dot_diameter_mm = {}, .usual_spread_mm = 30},
      OptionsFor(MirrorSide::kRight, 45)));
  // The heights of the seven dots at rest.
  double sum = 0, squares = 0;
  for (const Eigen::Vector3d& point : FaceAt(0, 1)) {
    sum += point.y() / 7;
    squares += point.y() * point.y() / 7;
  }
  const double spread_mm = std::sqrt(squares - sum * sum);
  const double truth_mm = TrueArray(45, 1).mirrors[0].distance_mm;
  EXPECT_NEAR(found.array.mirrors[0].distance_mm / truth_mm, 30 / spread_mm,
              found.scale_sigma * 30 / spread_mm);
}

TEST(NominalMirrorTest, WhatCannotBeIsRefusedWithWords) {
  const CameraArray truth = TrueArray(45, 1);
  const DotVideo video = Film(truth, 1, 0.05);
  EXPECT_THAT(RefusalOf(video, {}), HasSubstr("Say --mirror-side left or right"));
  EXPECT_THAT(RefusalOf(video, OptionsFor(MirrorSide::kLeft, 45)), HasSubstr("do not match"));
  EXPECT_THAT(RefusalOf(Film(truth, 1, 0.05, 3), OptionsFor(MirrorSide::kRight, 45)),
              HasSubstr("3 of 3 frames"));
  DotVideo no_mirror = video;
  for (DotPicture& picture : no_mirror.pictures)
    std::erase_if(picture.dots, [](const Dot& dot) { return dot.center_px.x() > 640; });
  EXPECT_THAT(RefusalOf(no_mirror, OptionsFor(MirrorSide::kRight, 45)),
              HasSubstr("is there a mirror in the picture"));
  EXPECT_THAT(RefusalOf({.camera = "front", .width = 1280, .height = 720},
                        OptionsFor(MirrorSide::kRight, 45)),
              HasSubstr("are its dots found"));
  NominalMirrorOptions options = OptionsFor(MirrorSide::kRight, 45);
  options.mirror_angle_deg = 80;
  EXPECT_FALSE(CheckOptions(options));
  options = OptionsFor(MirrorSide::kRight, 45);
  options.mirror_angle_sigma_deg = 0;
  EXPECT_FALSE(CheckOptions(options));
}

}  // namespace
}  // namespace articap
