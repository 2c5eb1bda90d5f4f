// SPDX-License-Identifier: MIT
#include "calib/lens_solver.h"
#include "calib/lens_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "calib/planar_pose.h"
#include "calib/view_screening.h"
#include "tests/calib/network_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

TEST(LensSolverTest, PerfectCornersGiveTheLensBack) {
  const NetworkScene scene = LensScene(1, 12);
  const auto solved = SolveLens(scene.board, SeeBoards(scene, 0, 1)[0], {});
  ASSERT_TRUE(solved) << solved.error().message;
  const Lens& truth = scene.array.cameras[0].lens;
  const Lens& lens = solved->adjusted.network.array.cameras[0].lens;
  EXPECT_NEAR(lens.fx_px, truth.fx_px, 1e-4);
  EXPECT_NEAR(lens.fy_px, truth.fy_px, 1e-4);
  EXPECT_NEAR(lens.cx_px, truth.cx_px, 1e-4);
  EXPECT_NEAR(lens.cy_px, truth.cy_px, 1e-4);
  for (int i = 0; i < Lens::kNumDistortion; ++i)
    EXPECT_NEAR(lens.distortion[i], truth.distortion[i], 1e-5) << i;
  EXPECT_EQ(solved->model, LensModel::kBrown5);
}

TEST(LensSolverTest, ErrorsAreWhatTheSigmasSay) {
  LensOptions options;
  options.simplify = false;
  double normalized2 = 0;
  int count = 0;
  constexpr int kSeeds = 20;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NetworkScene scene = LensScene(seed, 15);
    const auto solved = SolveLens(scene.board, SeeBoards(scene, 0.1, 50 + seed)[0], options);
    ASSERT_TRUE(solved) << solved.error().message;
    const Camera& found = solved->adjusted.network.array.cameras[0];
    const Lens& truth = scene.array.cameras[0].lens;
    for (const double sigmas :
         {(found.lens.fx_px - truth.fx_px) / found.sigmas.fx_px,
          (found.lens.fy_px - truth.fy_px) / found.sigmas.fy_px,
          (found.lens.cx_px - truth.cx_px) / found.sigmas.cx_px,
          (found.lens.cy_px - truth.cy_px) / found.sigmas.cy_px,
          (found.lens.distortion[0] - truth.distortion[0]) / found.sigmas.distortion[0]}) {
      EXPECT_LT(std::abs(sigmas), 5.5) << "seed " << seed;
      normalized2 += sigmas * sigmas;
      ++count;
    }
    EXPECT_NEAR(solved->adjusted.sigma_px, 0.1, 0.01);
  }
  // fx and fy go together, so that there are about 4 x 20 independent squares: 1 +- 3 sqrt(2 / 80).
  EXPECT_NEAR(normalized2 / count, 1, 0.48);
}

TEST(LensSolverTest, CoefficientsThatTheViewsDoNotShowAreLeftOut) {
  // By Akaike's criterion pure noise passes for k3 once in 6, for p1 and p2 once in 7.
  int left_out = 0;
  constexpr int kSeeds = 10;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    NetworkScene scene = LensScene(seed, 15);
    scene.array.cameras[0].lens.distortion = {-0.1, 0, 0, 0, 0, 0, 0, 0};
    const auto solved = SolveLens(scene.board, SeeBoards(scene, 0.1, seed)[0], {});
    ASSERT_TRUE(solved) << solved.error().message;
    EXPECT_GE(solved->model, LensModel::kK1);
    EXPECT_NEAR(solved->adjusted.network.array.cameras[0].lens.distortion[0], -0.1, 0.01);
    left_out += solved->model <= LensModel::kK1K2;
  }
  EXPECT_GE(left_out, 4);  // 7 of 10 are expected
}

TEST(LensSolverTest, ARationalModelWithoutSupportIsRefused) {
  const NetworkScene scene = LensScene(4, 13);
  LensOptions options;
  options.model = LensModel::kRational;
  const auto solved = SolveLens(scene.board, SeeBoards(scene, 0.15, 4)[0], options);
  ASSERT_TRUE(solved) << solved.error().message;
  EXPECT_LE(solved->model, LensModel::kBrown5);
  ASSERT_EQ(solved->warnings.size(), 1U);
  EXPECT_THAT(solved->warnings[0], HasSubstr("the rational model is refused"));
}

TEST(LensSolverTest, DisplacedCornersAreNamed) {
  const NetworkScene scene = LensScene(5, 13);
  CameraSightings seen = SeeBoards(scene, 0.1, 5)[0];
  for (int corner : {3, 12, 40}) seen.sightings[7].points_px[corner].x() += 4 + corner / 10.0;
  const auto lens = CalibrateLens(scene.board, seen, {});
  ASSERT_TRUE(lens) << lens.error().message;
  EXPECT_TRUE(lens->report.IsUsable()) << lens->report.verdict;
  std::vector<std::string> named;
  for (const SightingResult& sighting : lens->output.sightings)
    if (!sighting.used) named.push_back(sighting.source + ": " + sighting.reason);
  ASSERT_EQ(named.size(), 1U);
  EXPECT_THAT(named[0], HasSubstr("007.png: "));
  EXPECT_THAT(named[0], HasSubstr("corner 40 by 8.0 px, corner 12 by 5"));
  EXPECT_NEAR(lens->output.array.cameras[0].lens.fx_px, 533,
              4 * lens->output.array.cameras[0].sigmas.fx_px);
}

TEST(LensSolverTest, OtherBoardsCornersMakeNoLens) {
  // Corners of 8 x 7 instead of 9 x 6, counted as those of the latter.
  NetworkScene scene = LensScene(6, 12);
  scene.board = ParseBoardSpec("chessboard:6x9:25").value();
  const CameraSightings seen = SeeBoards(scene, 0.1, 6)[0];
  const auto lens = CalibrateLens(ParseBoardSpec("chessboard:9x6:25").value(), seen, {});
  EXPECT_TRUE(!lens || !lens->report.IsUsable());
}

TEST(LensSolverTest, ViewsThatAreAllParallelDoNotTellTheFocalLength) {
  NetworkScene scene = LensScene(7, 12);
  for (int i = 0; i < static_cast<int>(scene.stage_from_board.size()); ++i)
    scene.stage_from_board[i] = {Eigen::Quaterniond::Identity(),
                                 {-150.0 + 4 * i, -80.0 + 3 * i, 500.0}};
  const auto lens = CalibrateLens(scene.board, SeeBoards(scene, 0.1, 7)[0], {});
  ASSERT_TRUE(lens) << lens.error().message;
  EXPECT_FALSE(lens->report.IsUsable());
  EXPECT_THAT(lens->report.verdict, HasSubstr("the views are too parallel"));
}

TEST(LensSolverTest, APinholeHasNoDistortion) {
  NetworkScene scene = LensScene(9, 12);
  LensOptions options;
  options.model = LensModel::kPinhole;
  const auto solved = SolveLens(scene.board, SeeBoards(scene, 0.1, 9)[0], options);
  ASSERT_TRUE(solved) << solved.error().message;
  for (double coefficient : solved->adjusted.network.array.cameras[0].lens.distortion)
    EXPECT_EQ(coefficient, 0);
}

// While only k1 is known, it folds the picture over before the corners of a wide lens' picture. The
// views that reach there are the ones that matter.
TEST(LensSolverTest, BoardsPartlyBeyondTheFoldOfARoughLensArePlaced) {
  NetworkScene scene = LensScene(1, 1);
  Lens& lens = scene.array.cameras[0].lens;
  lens = {270, 270.5, 322, 238, {-0.28, 0.08, 0, 0, -0.009}};
  const Rigid3d truth{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX())),
                      {60, -20, 280}};
  scene.stage_from_board = {truth};
  const BoardSighting seen = SeeBoards(scene, 0.1, 1)[0].sightings.at(0);
  lens.distortion = {-0.28};
  const auto beyond =
      std::count_if(seen.points_px.begin(), seen.points_px.end(),
                    [&](const Eigen::Vector2d& point) { return !Unproject(lens, point); });
  ASSERT_GT(beyond, 0);
  const auto poses = PlanarPosesOf(scene.board, lens, seen.corners, seen.points_px);
  ASSERT_FALSE(poses.empty());
  EXPECT_LT((poses[0].cam_from_board.translation_mm - truth.translation_mm).norm(), 30);
  EXPECT_LT(poses[0].cam_from_board.rotation.angularDistance(truth.rotation), 0.3);
}

// One corner in twenty is anywhere within 8 px. Least squares over all of them would make the
// sigmas three times as large as the errors are.
TEST(LensSolverTest, OutliersDoNotMakeTheSigmasDishonest) {
  LensOptions options;
  options.simplify = false;
  double normalized2 = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const NetworkScene scene = LensScene(seed, 20);
    CameraSightings seen = SeeBoards(scene, 0.1, 70 + seed)[0];
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> away(-8, 8);
    for (BoardSighting& sighting : seen.sightings)
      for (Eigen::Vector2d& point : sighting.points_px)
        if (random() % 20 == 0) point += Eigen::Vector2d{away(random), away(random)};
    const auto solved = SolveLens(scene.board, seen, options);
    ASSERT_TRUE(solved) << solved.error().message;
    EXPECT_NEAR(solved->adjusted.sigma_px, 0.11, 0.02);
    const Camera& found = solved->adjusted.network.array.cameras[0];
    const Lens& truth = scene.array.cameras[0].lens;
    for (const double sigmas : {(found.lens.fx_px - truth.fx_px) / found.sigmas.fx_px,
                                (found.lens.cx_px - truth.cx_px) / found.sigmas.cx_px,
                                (found.lens.cy_px - truth.cy_px) / found.sigmas.cy_px}) {
      normalized2 += sigmas * sigmas;
      ++count;
    }
  }
  EXPECT_NEAR(normalized2 / count, 1, 3 * std::sqrt(2.0 / count));
}

TEST(LensSolverTest, SightingsWithoutAPoseAreSetAsideByName) {
  const NetworkScene scene = LensScene(10, 13);
  CameraSightings seen = SeeBoards(scene, 0.1, 10)[0];
  seen.sightings[2].points_px[7].x() = std::numeric_limits<double>::infinity();
  for (const auto& [index, corners] : {std::pair{5, 9}, std::pair{8, 3}}) {  // on a line; too few
    seen.sightings[index].corners.resize(corners);
    seen.sightings[index].points_px.resize(corners);
  }
  const auto lens = CalibrateLens(scene.board, seen, {});
  ASSERT_TRUE(lens) << lens.error().message;
  EXPECT_TRUE(lens->report.IsUsable()) << lens->report.verdict;
  ASSERT_EQ(lens->output.sightings.size(), seen.sightings.size());
  for (int i = 0; i < static_cast<int>(seen.sightings.size()); ++i) {
    const SightingResult& sighting = lens->output.sightings[i];
    const bool bad = sighting.source == "002.png" || sighting.source == "005.png" ||
                     sighting.source == "008.png";
    EXPECT_EQ(sighting.used, !bad) << sighting.source;
    if (bad) {
      EXPECT_THAT(sighting.reason, HasSubstr("no pose of the board explains its corners"));
    }
  }
}

TEST(LensSolverTest, CornersFoundAnywhereMakeNoPlane) {
  const NetworkScene scene = LensScene(11, 12);
  CameraSightings seen = SeeBoards(scene, 0.1, 11)[0];
  std::mt19937 random(11);
  for (BoardSighting& sighting : seen.sightings)
    std::shuffle(sighting.points_px.begin(), sighting.points_px.end(), random);
  const auto lens = CalibrateLens(scene.board, seen, {});
  EXPECT_TRUE(!lens || !lens->report.IsUsable());
  seen.lens = Lens{100, 100, 320, 240, {-0.4}};
  seen.sightings = SeeBoards(scene, 0.1, 11)[0].sightings;
  const auto other = CalibrateLens(scene.board, seen, {});
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("is the lens that of this camera"));
}

// Four corners in each of five pictures: the residuals are next to nothing, whatever the lens.
TEST(LensSolverTest, HardlyMoreCornersThanUnknownsAreNotUsable) {
  const NetworkScene scene = LensScene(12, 5);
  CameraSightings seen = SeeBoards(scene, 0.1, 12)[0];
  for (BoardSighting& sighting : seen.sightings) {
    std::vector<Eigen::Vector2d> points;
    for (int corner : {0, 8, 45, 53}) points.push_back(sighting.points_px[corner]);
    sighting.points_px = points;
    sighting.corners = {0, 8, 45, 53};
  }
  const auto lens = CalibrateLens(scene.board, seen, {});
  ASSERT_TRUE(lens) << lens.error().message;
  EXPECT_FALSE(lens->report.IsUsable());
  EXPECT_THAT(lens->report.verdict, HasSubstr("more coordinates than there are unknowns"));
}

TEST(LensSolverTest, AFewPicturesAreNotEnough) {
  const NetworkScene scene = LensScene(8, 2);
  const auto lens = CalibrateLens(scene.board, SeeBoards(scene, 0.1, 8)[0], {});
  ASSERT_FALSE(lens);
  EXPECT_THAT(lens.error().message, HasSubstr("2 usable pictures of the board"));
}

}  // namespace
}  // namespace articap
