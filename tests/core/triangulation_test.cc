// SPDX-License-Identifier: MIT
#include "core/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

namespace articap {
namespace {

// Three cameras on an arc of 60 degrees, 800 mm from a point.
CameraArray ThreeCameras() {
  const Eigen::Vector3d middle{0, 0, 800};
  CameraArray array;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5 * i, Eigen::Vector3d::UnitY()));
    Camera camera{.width = 1280, .height = 720, .lens = {1200, 1200, 640, 360, {-0.1}}};
    camera.cam_from_stage = {turn, middle - turn * middle};
    array.cameras.push_back(camera);
  }
  return array;
}

TEST(TriangulationTest, SightsWeighByTheirNoise) {
  constexpr int kPoints = 500;
  const std::array<double, 3> sigmas_px = {0.1, 0.5, 0.1};
  const CameraArray array = ThreeCameras();
  std::mt19937 random(1);
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> place_mm(-80, 80);
  double mahalanobis2 = 0, squares_mm2 = 0, alike_mm2 = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d truth{place_mm(random), place_mm(random), 800 + place_mm(random)};
    std::vector<Sight> sights;
    for (int camera = 0; camera < 3; ++camera) {
      const auto point = Project(array, {camera, -1}, truth);
      ASSERT_TRUE(point);
      sights.push_back(
          {{camera, -1},
           *point + sigmas_px[camera] * Eigen::Vector2d{gaussian(random), gaussian(random)},
           sigmas_px[camera]});
    }
    const auto found = Triangulate(array, sights);
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->point_in_stage_mm - truth;
    mahalanobis2 += error.dot(found->covariance_mm2.ldlt().solve(error));
    squares_mm2 += error.squaredNorm();
    for (Sight& sight : sights) sight.sigma_px = 1;
    const auto alike = Triangulate(array, sights);
    ASSERT_TRUE(alike);
    alike_mm2 += (alike->point_in_stage_mm - truth).squaredNorm();
  }
  const double freedoms = 3 * kPoints;
  EXPECT_NEAR(mahalanobis2 / freedoms, 1, 3.29 * std::sqrt(2 / freedoms));
  EXPECT_LT(squares_mm2, 0.5 * alike_mm2);
}

}  // namespace
}  // namespace articap
