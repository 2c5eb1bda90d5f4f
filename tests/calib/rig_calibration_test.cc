// SPDX-License-Identifier: MIT
#include "calib/rig_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdlib>

#include "tests/calib/network_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

TEST(RigCalibrationTest, PerfectCornersGiveTheRigBack) {
  const NetworkScene scene = RigScene(1, 4, 24);
  const auto rig = CalibrateRig(scene.board, SeeBoards(scene, 0, 1), {}, {});
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_TRUE(rig->report.IsUsable()) << rig->report.verdict;
  for (std::size_t i = 0; i < scene.array.cameras.size(); ++i) {
    const Camera& truth = scene.array.cameras[i];
    const Camera& camera = rig->output.array.cameras[i];
    EXPECT_NEAR(camera.lens.fx_px, truth.lens.fx_px, 1e-3) << i;
    EXPECT_LT((camera.cam_from_stage.translation_mm - truth.cam_from_stage.translation_mm).norm(),
              1e-3)
        << i;
    EXPECT_LT(camera.cam_from_stage.rotation.angularDistance(truth.cam_from_stage.rotation), 1e-6);
  }
}

// The error of each free parameter of the cameras.
Eigen::VectorXd ErrorsOf(const Calibration& calibration, const CameraArray& truth) {
  using Kind = CameraParameter::Kind;
  Eigen::VectorXd errors(calibration.parameters.size());
  for (int i = 0; i < errors.size(); ++i) {
    const CameraParameter& parameter = calibration.parameters[i];
    const Camera& found = calibration.array.cameras[parameter.index];
    const Camera& right = truth.cameras[parameter.index];
    const Eigen::AngleAxisd turn(found.cam_from_stage.rotation *
                                 right.cam_from_stage.rotation.conjugate());
    switch (parameter.kind) {
      case Kind::kFocal:
        errors(i) = found.lens.fx_px - right.lens.fx_px;
        break;
      case Kind::kAspect:
        errors(i) = found.lens.fy_px / found.lens.fx_px - right.lens.fy_px / right.lens.fx_px;
        break;
      case Kind::kPrincipalX:
        errors(i) = found.lens.cx_px - right.lens.cx_px;
        break;
      case Kind::kPrincipalY:
        errors(i) = found.lens.cy_px - right.lens.cy_px;
        break;
      case Kind::kDistortion:
        errors(i) =
            found.lens.distortion[parameter.component] - right.lens.distortion[parameter.component];
        break;
      case Kind::kRotation:
        errors(i) = turn.angle() * turn.axis()[parameter.component];
        break;
      case Kind::kTranslation:
        errors(i) = found.cam_from_stage.translation_mm[parameter.component] -
                    right.cam_from_stage.translation_mm[parameter.component];
        break;
      case Kind::kMirror:
      case Kind::kTimeOffset:
        ADD_FAILURE() << "not of a synchronous rig";
        break;
    }
  }
  return errors;
}

struct RigStatistics {
  double mahalanobis2 = 0;  // summed over seeds
  int degrees_of_freedom = 0;
  double largest_sigmas = 0;
  double normalized2 = 0;
  double rigidity2 = 0, expected_rigidity2 = 0;
};

RigStatistics RunSeeds(int num_cameras, int num_placements, int num_seeds) {
  constexpr double kNoise_px = 0.1;
  RigStatistics statistics;
  LensOptions lens;
  lens.model = LensModel::kBrown4;  // the truth
  lens.simplify = false;            // a choice that depends on the noise has no Gaussian errors
  for (int seed = 1; seed <= num_seeds; ++seed) {
    const NetworkScene scene = RigScene(seed, num_cameras, num_placements);
    const auto rig = CalibrateRig(scene.board, SeeBoards(scene, kNoise_px, 1000 + seed), lens, {});
    if (!rig) {
      ADD_FAILURE() << "seed " << seed << ": " << rig.error().message;
      continue;
    }
    EXPECT_TRUE(rig->report.IsUsable()) << rig->report.verdict;
    const Calibration& found = rig->output;
    const Eigen::VectorXd errors = ErrorsOf(found, scene.array);
    statistics.mahalanobis2 += errors.dot(found.covariance.ldlt().solve(errors));
    statistics.degrees_of_freedom += static_cast<int>(errors.size());
    const Eigen::ArrayXd sigmas = errors.array().abs() / found.covariance.diagonal().array().sqrt();
    statistics.largest_sigmas = std::max(statistics.largest_sigmas, sigmas.maxCoeff());
    statistics.normalized2 += sigmas.square().sum();
    statistics.rigidity2 += std::pow(found.held_out.rigidity_mm, 2);
    statistics.expected_rigidity2 += std::pow(found.held_out.expected_rigidity_mm, 2);
  }
  return statistics;
}

class RigStatisticsTest : public testing::TestWithParam<int> {};

TEST_P(RigStatisticsTest, ErrorsAreWhatTheSigmasSay) {
  const bool is_long = std::getenv("ARTICAP_LONG_TESTS") != nullptr;
  const int num_seeds = is_long ? 100 : 8;
  const RigStatistics statistics = RunSeeds(GetParam(), 40, num_seeds);
  const double per_freedom = statistics.mahalanobis2 / statistics.degrees_of_freedom;
  // Chi-square of n degrees of freedom over n: Gaussian of variance 2 / n for the n in the hundreds
  // and thousands here; 3.29 sigmas hold 99.9 %.
  const double interval = 3.29 * std::sqrt(2.0 / statistics.degrees_of_freedom);
  RecordProperty("mahalanobis2_per_freedom", std::to_string(per_freedom));
  std::printf(
      "%d cameras, %d seeds: Mahalanobis^2 per degree of freedom %.4f (1 +- %.4f), largest "
      "%.2f sigmas, pooled variance %.4f, held-out rigidity %.4f mm = %.3f of what the "
      "noise allows\n",
      GetParam(), num_seeds, per_freedom, interval, statistics.largest_sigmas,
      statistics.normalized2 / statistics.degrees_of_freedom,
      std::sqrt(statistics.rigidity2 / num_seeds),
      std::sqrt(statistics.rigidity2 / statistics.expected_rigidity2));
  EXPECT_NEAR(per_freedom, 1, interval);
  EXPECT_LT(statistics.largest_sigmas, 5.5);
  // Parameters of one rig are correlated: few seeds scatter more.
  EXPECT_NEAR(statistics.normalized2 / statistics.degrees_of_freedom, 1, is_long ? 0.05 : 0.25);
  EXPECT_LT(std::sqrt(statistics.rigidity2 / statistics.expected_rigidity2), 1.2);
}

INSTANTIATE_TEST_SUITE_P(Cameras, RigStatisticsTest, testing::Values(2, 4, 8));

}  // namespace
}  // namespace articap
