// SPDX-License-Identifier: MIT
#include "calib/rig_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include "calib/network_screening.h"
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

// Squared errors of parameters over their variances, summed over parameters and seeds.
struct NormalizedErrors {
  double sum = 0;
  double sum_variance = 0;  // parameters of one rig are correlated
  int count = 0;

  void Add(const Eigen::VectorXd& errors, const Eigen::MatrixXd& covariance) {
    sum += (errors.array().square() / covariance.diagonal().array()).sum();
    // The squares of standard Gaussians with correlations r have covariances 2 r^2.
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
    sum_variance += 2 * correlation.squaredNorm();
    count += static_cast<int>(errors.size());
  }

  double variance() const { return sum / count; }
  double variance_sigma() const { return std::sqrt(sum_variance) / count; }
};

// What is said of the noise of one camera's corners.
struct NoiseFound {
  double squares = 0;  // of what was found over the truth, summed over seeds
  int coordinates = 0;
};

struct RigStatistics {
  explicit RigStatistics(std::size_t num_cameras) : cameras(num_cameras), noise(num_cameras) {}

  double mahalanobis2 = 0;  // summed over seeds
  double largest_sigmas = 0;
  NormalizedErrors all;
  std::vector<NormalizedErrors> cameras;  // of each one's parameters
  std::vector<NoiseFound> noise;
  double rigidity2 = 0, expected_rigidity2 = 0;

  double mahalanobis2_per_freedom() const { return mahalanobis2 / all.count; }
  // Chi-square of n degrees of freedom over n: Gaussian of variance 2 / n for the n in the hundreds
  // and thousands here; 3.29 sigmas hold 99.9 %.
  double mahalanobis2_interval() const { return 3.29 * std::sqrt(2.0 / all.count); }
};

void AddCameras(const Calibration& found, const Eigen::VectorXd& errors,
                RigStatistics& statistics) {
  for (int camera = 0; camera < static_cast<int>(statistics.cameras.size()); ++camera) {
    std::vector<int> rows;
    for (int i = 0; i < errors.size(); ++i)
      if (found.parameters[i].index == camera) rows.push_back(i);
    const Eigen::VectorXd own = errors(rows);
    statistics.cameras[camera].Add(own, found.covariance(rows, rows));
  }
}

// Each camera's corners with a noise of its own.
std::vector<CameraSightings> SeeWithNoise(const NetworkScene& scene,
                                          const std::vector<double>& noise_px, unsigned seed) {
  std::vector<CameraSightings> seen;
  for (std::size_t camera = 0; camera < noise_px.size(); ++camera)
    seen.push_back(SeeBoards(scene, noise_px[camera], seed)[camera]);
  return seen;
}

RigStatistics RunSeeds(const std::vector<double>& noise_px, int num_placements, int num_seeds) {
  const int num_cameras = static_cast<int>(noise_px.size());
  RigStatistics statistics(noise_px.size());
  LensOptions lens;
  lens.model = LensModel::kBrown4;  // the truth
  lens.simplify = false;            // a choice that depends on the noise has no Gaussian errors
  for (int seed = 1; seed <= num_seeds; ++seed) {
    const NetworkScene scene = RigScene(seed, num_cameras, num_placements);
    const std::vector<CameraSightings> seen = SeeWithNoise(scene, noise_px, 1000 + seed);
    const auto rig = CalibrateRig(scene.board, seen, lens, {});
    if (!rig) {
      ADD_FAILURE() << "seed " << seed << ": " << rig.error().message;
      continue;
    }
    EXPECT_TRUE(rig->report.IsUsable()) << rig->report.verdict;
    const Calibration& found = rig->output;
    const Eigen::VectorXd errors = ErrorsOf(found, scene.array);
    statistics.mahalanobis2 += errors.dot(found.covariance.ldlt().solve(errors));
    const Eigen::ArrayXd sigmas = errors.array().abs() / found.covariance.diagonal().array().sqrt();
    statistics.largest_sigmas = std::max(statistics.largest_sigmas, sigmas.maxCoeff());
    statistics.all.Add(errors, found.covariance);
    AddCameras(found, errors, statistics);
    for (std::size_t camera = 0; camera < noise_px.size(); ++camera)
      statistics.noise[camera].squares += std::pow(found.noise_px[camera] / noise_px[camera], 2);
    for (const SightingResult& sighting : found.sightings)
      statistics.noise[sighting.view.camera].coordinates +=
          2 * static_cast<int>(sighting.corners.size());
    statistics.rigidity2 += std::pow(found.held_out.rigidity_mm, 2);
    statistics.expected_rigidity2 += std::pow(found.held_out.expected_rigidity_mm, 2);
  }
  return statistics;
}

int NumSeeds() { return std::getenv("ARTICAP_LONG_TESTS") != nullptr ? 100 : 8; }

class RigStatisticsTest : public testing::TestWithParam<int> {};

TEST_P(RigStatisticsTest, ErrorsAreWhatTheSigmasSay) {
  const int num_seeds = NumSeeds();
  const RigStatistics statistics =
      RunSeeds(std::vector<double>(static_cast<std::size_t>(GetParam()), 0.1), 40, num_seeds);
  const double per_freedom = statistics.mahalanobis2_per_freedom();
  const double interval = statistics.mahalanobis2_interval();
  RecordProperty("mahalanobis2_per_freedom", std::to_string(per_freedom));
  std::printf(
      "%d cameras, %d seeds: Mahalanobis^2 per degree of freedom %.4f (1 +- %.4f), largest "
      "%.2f sigmas, pooled variance %.4f (standard error %.4f), held-out rigidity %.4f mm = %.3f "
      "of what the "
      "noise allows\n",
      GetParam(), num_seeds, per_freedom, interval, statistics.largest_sigmas,
      statistics.all.variance(), statistics.all.variance_sigma(),
      std::sqrt(statistics.rigidity2 / num_seeds),
      std::sqrt(statistics.rigidity2 / statistics.expected_rigidity2));
  EXPECT_NEAR(per_freedom, 1, interval);
  EXPECT_LT(statistics.largest_sigmas, 5.5);
  // 5 %, or what so few seeds of so correlated parameters may scatter.
  EXPECT_NEAR(statistics.all.variance(), 1, std::max(0.05, 3.29 * statistics.all.variance_sigma()));
  EXPECT_LT(std::sqrt(statistics.rigidity2 / statistics.expected_rigidity2), 1.2);
}

INSTANTIATE_TEST_SUITE_P(Cameras, RigStatisticsTest, testing::Values(2, 4, 8));

// Were all cameras' noise taken for one, the sigmas of the noisy one would be too small by half,
// those of the others too large.
TEST(RigNoiseTest, EachCamerasSigmasGoByItsOwnNoise) {
  const std::vector<double> noise_px = {0.1, 0.5, 0.1, 0.1};
  const int num_seeds = NumSeeds();
  const RigStatistics statistics = RunSeeds(noise_px, 40, num_seeds);
  std::printf("Mahalanobis^2 per degree of freedom %.4f (1 +- %.4f), largest %.2f sigmas\n",
              statistics.mahalanobis2_per_freedom(), statistics.mahalanobis2_interval(),
              statistics.largest_sigmas);
  EXPECT_NEAR(statistics.mahalanobis2_per_freedom(), 1, statistics.mahalanobis2_interval());
  EXPECT_LT(statistics.largest_sigmas, 5.5);
  for (std::size_t camera = 0; camera < noise_px.size(); ++camera) {
    const NormalizedErrors& errors = statistics.cameras[camera];
    const NoiseFound& noise = statistics.noise[camera];
    const double noise2 = noise.squares / num_seeds;
    std::printf("  cam%zu: normalised variance %.3f (1 +- %.3f), noise %.4f of %.1f px\n", camera,
                errors.variance(), 3.29 * errors.variance_sigma(),
                std::sqrt(noise2) * noise_px[camera], noise_px[camera]);
    EXPECT_NEAR(errors.variance(), 1, 3.29 * errors.variance_sigma()) << camera;
    // The placements take up a tenth of the coordinates at most.
    EXPECT_NEAR(noise2, 1, 3.29 * std::sqrt(2 / (0.9 * noise.coordinates))) << camera;
  }
  EXPECT_LT(std::sqrt(statistics.rigidity2 / statistics.expected_rigidity2), 1.2);
}

TEST(RigCalibrationTest, CamerasThatNothingLinksAreNamed) {
  const NetworkScene scene = RigScene(2, 3, 24);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 2);
  for (BoardSighting& sighting : seen[2].sightings) sighting.frame += 1000;
  const auto rig = CalibrateRig(scene.board, seen, {}, {});
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().message, HasSubstr("cam2 never sees the board at the same time as cam0"));
}

TEST(RigCalibrationTest, CamerasThatNeverMeetAreLinkedThroughAThird) {
  const NetworkScene scene = RigScene(3, 3, 40);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.05, 3);
  // The first camera looks at even placements only, the last at odd ones, the second at all.
  std::erase_if(seen[0].sightings, [](const BoardSighting& s) { return s.frame % 2 != 0; });
  std::erase_if(seen[2].sightings, [](const BoardSighting& s) { return s.frame % 2 == 0; });
  const auto rig = CalibrateRig(scene.board, seen, {}, {});
  ASSERT_TRUE(rig) << rig.error().message;
  for (int i : {1, 2}) {
    const Camera& found = rig->output.array.cameras[i];
    const Rigid3d& truth = scene.array.cameras[i].cam_from_stage;
    EXPECT_LT((found.cam_from_stage.translation_mm - truth.translation_mm).norm(),
              5 * found.sigmas.translation_mm.norm());
  }
}

TEST(RigCalibrationTest, PicturesPairedWrongAreRefused) {
  const NetworkScene scene = RigScene(4, 2, 20);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 4);
  for (BoardSighting& sighting : seen[1].sightings) sighting.frame = (sighting.frame + 1) % 20;
  const auto rig = CalibrateRig(scene.board, seen, {}, {});
  EXPECT_TRUE(!rig || !rig->report.IsUsable());
  if (!rig) {
    EXPECT_THAT(rig.error().message, HasSubstr("same instants"));
  }
}

TEST(RigCalibrationTest, BoardsThatLookTheSameUpsideDownAreRefused) {
  const auto rig = CalibrateRig(ParseBoardSpec("chessboard:8x6:25").value(), {{}, {}}, {}, {});
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().message, HasSubstr("looks the same upside down"));
}

// Its residuals are five times the others': so are its views', and none of them is bad.
TEST(RigCalibrationTest, ACameraThatIsNoisierThanTheOthersKeepsItsViews) {
  const NetworkScene scene = RigScene(1, 4, 30);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 1);
  seen[1] = SeeBoards(scene, 0.5, 2)[1];
  const auto rig = CalibrateRig(scene.board, seen, {}, {});
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_TRUE(rig->report.IsUsable()) << rig->report.verdict;
  for (const SightingResult& sighting : rig->output.sightings) EXPECT_TRUE(sighting.used);
  EXPECT_GT(rig->output.array.cameras[1].sigmas.translation_mm.minCoeff(), 0);
}

// The one view that two cameras share is wrong, and set aside: nothing links them then.
TEST(RigCalibrationTest, ACameraThatHangsOnAWrongViewIsNotUsable) {
  const NetworkScene scene = RigScene(1, 2, 20);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 1);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i].lens = scene.array.cameras[i].lens;
  for (BoardSighting& sighting : seen[1].sightings) sighting.frame += 1000;
  BoardSighting& shared = seen[1].sightings[0];
  shared.frame = seen[0].sightings[10].frame;
  RigOptions held;
  held.adjust_lenses = false;
  const auto rig = CalibrateRig(scene.board, seen, {}, held);
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_TRUE(rig->report.IsUsable()) << "one shared view is just enough";
  for (std::size_t i = 0; i < shared.points_px.size(); ++i)
    shared.points_px[i].y() += i % 2 == 0 ? 3 : -3;
  const auto wrong = CalibrateRig(scene.board, seen, {}, held);
  ASSERT_TRUE(wrong) << wrong.error().message;
  EXPECT_FALSE(wrong->report.IsUsable());
  EXPECT_THAT(wrong->report.verdict, HasSubstr("cam1: where it stands cannot be told"));
}

TEST(RigCalibrationTest, LensesThatAreHeldAndWrongAreNamed) {
  RigOptions held;
  held.adjust_lenses = false;
  for (int wrong : {0, 2}) {
    const NetworkScene scene = RigScene(7, 3, 30);
    std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 7);
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i].lens = scene.array.cameras[i].lens;
    const auto good = CalibrateRig(scene.board, seen, {}, held);
    ASSERT_TRUE(good) << good.error().message;
    EXPECT_TRUE(good->report.IsUsable()) << good->report.verdict;
    seen[wrong].lens->fx_px *= 1.05;
    seen[wrong].lens->fy_px *= 1.05;
    const auto rig = CalibrateRig(scene.board, seen, {}, held);
    ASSERT_TRUE(rig) << rig.error().message;
    EXPECT_FALSE(rig->report.IsUsable());
    EXPECT_THAT(rig->report.verdict, HasSubstr(seen[wrong].camera + ": its lens was held at"));
    held.max_held_focal_percent = 6;
    EXPECT_TRUE(CalibrateRig(scene.board, seen, {}, held)->report.IsUsable());
    held.max_held_focal_percent = 2;
  }
}

// Where the corners themselves are good, what is wrong with the array shows in how they are off.
TEST(RigCalibrationTest, ACameraThatMovedBetweenPicturesIsNotUsable) {
  NetworkScene scene = RigScene(8, 2, 40);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.02, 8);
  scene.array.cameras[1].cam_from_stage.translation_mm.y() += 0.4;
  const std::vector<CameraSightings> later = SeeBoards(scene, 0.02, 8);
  for (std::size_t i = 0; i < seen[1].sightings.size(); ++i)
    if (seen[1].sightings[i].frame >= 20) seen[1].sightings[i] = later[1].sightings[i];
  const auto rig = CalibrateRig(scene.board, seen, {}, {});
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_FALSE(rig->report.IsUsable()) << rig->report.verdict;
  EXPECT_THAT(rig->report.verdict, HasSubstr("did it move between pictures"));
}

TEST(RigCalibrationTest, BoardsBehindTheCamerasAreSetAside) {
  const NetworkScene scene = RigScene(1, 2, 12);
  const std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 1);
  Network network;
  network.board = scene.board;
  network.array = scene.array;
  for (const Rigid3d& pose : scene.stage_from_board) network.placements.push_back({pose, 0});
  for (int camera = 0; camera < 2; ++camera)
    for (int i = 0; i < static_cast<int>(seen[camera].sightings.size()); ++i) {
      const BoardSighting& sighting = seen[camera].sightings[i];
      network.sightings.push_back({{camera, -1},
                                   static_cast<int>(sighting.frame),
                                   0,
                                   i,
                                   sighting.corners,
                                   sighting.points_px});
    }
  constexpr int kWrong = 4;
  network.placements[kWrong].stage_from_board.translation_mm.z() = -1000;
  AdjustOptions held;
  held.lenses.resize(2);
  LeftOutSightings set_aside;
  const AdjustedNetwork adjusted = AdjustAndScreen(network, held, {}, set_aside);
  EXPECT_TRUE(adjusted.converged) << adjusted.solver_message;
  EXPECT_NEAR(adjusted.sigma_px, 0.1, 0.02);
  ASSERT_FALSE(set_aside.empty());
  for (const auto& [key, reason] : set_aside) {
    EXPECT_EQ(seen[key.camera].sightings[key.sighting].frame, kWrong);
    EXPECT_THAT(reason, HasSubstr("behind this camera"));
  }
}

TEST(RigCalibrationTest, ACameraWithoutViewsIsNamed) {
  const NetworkScene scene = RigScene(5, 2, 12);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 5);
  seen[1].sightings.clear();
  const auto rig = CalibrateRig(scene.board, seen, {}, {});
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().message, HasSubstr("cam1: no picture shows the board"));
}

// A board that is moved slowly before cameras whose clocks differ.
TEST(RigCalibrationTest, TimeOffsetsOfAMovingBoardComeOut) {
  constexpr double kRate_hz = 30;
  NetworkScene scene = RigScene(6, 3, 1);
  const std::array<double, 3> offsets_s = {0, 0.011, -0.014};
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<CameraSightings> seen;
  for (int i = 0; i < 3; ++i) {
    const Camera& camera = scene.array.cameras[i];
    CameraSightings& sightings =
        seen.emplace_back(CameraSightings{camera.name, camera.width, camera.height, {}, {}});
    for (int frame = 0; frame < 120; ++frame) {
      BoardSighting sighting;
      sighting.frame = frame;
      sighting.time = TimeOfFrame(frame, kRate_hz);
      const double t = SecondsOf(sighting.time) + offsets_s[i];
      const Eigen::Quaterniond turn =
          Eigen::AngleAxisd(0.6 + 0.5 * std::sin(2.1 * t), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(0.4 * std::sin(1.7 * t + 1), Eigen::Vector3d::UnitX());
      const Eigen::Vector3d middle{60 * std::sin(1.3 * t), 50 * std::cos(1.9 * t),
                                   800 + 60 * std::sin(1.1 * t)};
      const Rigid3d pose{turn, middle - turn * Eigen::Vector3d{80, 50, 0}};
      bool visible = true;
      for (int corner = 0; corner < scene.board.num_corners() && visible; ++corner) {
        const auto point = Project(
            camera.lens, camera.cam_from_stage * (pose * scene.board.corner_in_board_mm(corner)));
        visible = point.has_value();
        if (!visible) break;
        sighting.corners.push_back(corner);
        sighting.points_px.push_back(*point + Eigen::Vector2d{noise(random), noise(random)});
      }
      if (visible) sightings.sightings.push_back(std::move(sighting));
    }
  }
  RigOptions options;
  options.free_time_offsets = true;
  LensOptions lens;
  lens.model = LensModel::kBrown4;  // the truth
  lens.simplify = false;
  const auto rig = CalibrateRig(scene.board, seen, lens, options);
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_TRUE(rig->report.IsUsable()) << rig->report.BriefReport();
  for (int i : {1, 2}) {
    const Camera& found = rig->output.array.cameras[i];
    EXPECT_NEAR(found.time_offset_s, offsets_s[i], 0.02 / kRate_hz);
    EXPECT_NEAR(found.time_offset_s, offsets_s[i], 5 * found.sigmas.time_offset_s);
    EXPECT_LT(
        (found.cam_from_stage.translation_mm - scene.array.cameras[i].cam_from_stage.translation_mm)
            .norm(),
        5 * found.sigmas.translation_mm.norm());
  }
  EXPECT_NEAR(rig->output.sigma_px, 0.1, 0.01);
}

}  // namespace
}  // namespace articap
