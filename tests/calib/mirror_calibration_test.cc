// SPDX-License-Identifier: MIT
#include "calib/mirror_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/lens_model.h"
#include "tests/calib/network_scene.h"
#include "tests/calib/second_camera.h"

namespace articap {
namespace {

using testing::HasSubstr;

void ExpectSameMirror(const Mirror& found, const Mirror& truth, double angle_rad,
                      double distance_mm) {
  EXPECT_LT(std::acos(std::min(1.0, found.normal_in_stage.dot(truth.normal_in_stage))), angle_rad);
  EXPECT_NEAR(found.distance_mm, truth.distance_mm, distance_mm);
}

TEST(MirrorCalibrationTest, PerfectCornersGiveTheMirrorBack) {
  const NetworkScene scene = MirrorScene(1, 15);
  const auto found = CalibrateMirror(scene.board, SeeBoards(scene, 0, 1)[0], {}, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->report.IsUsable()) << found->report.verdict;
  EXPECT_NEAR(found->output.array.cameras[0].lens.fx_px, 1500, 1e-3);
  ExpectSameMirror(found->output.array.mirrors[0], scene.array.mirrors[0], 1e-6, 1e-3);
}

TEST(MirrorCalibrationTest, NoiseMovesTheMirrorAsFarAsItsSigmasSay) {
  int beyond_three = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const NetworkScene scene = MirrorScene(seed, 20);
    const auto found = CalibrateMirror(scene.board, SeeBoards(scene, 0.1, 100 + seed)[0], {}, {});
    ASSERT_TRUE(found) << found.error().message;
    const Mirror& mirror = found->output.array.mirrors[0];
    const Mirror& truth = scene.array.mirrors[0];
    const double angle_rad = mirror.normal_in_stage.cross(truth.normal_in_stage).norm();
    // The angle has two components, neither above the sigma.
    if (angle_rad > 3.5 * mirror.normal_sigma_rad) ++beyond_three;
    if (std::abs(mirror.distance_mm - truth.distance_mm) > 3 * mirror.distance_sigma_mm)
      ++beyond_three;
    EXPECT_LT(found->output.held_out.rigidity_mm,
              1.25 * found->output.held_out.expected_rigidity_mm);
  }
  // Of 16 chances of about 0.3 %.
  EXPECT_LE(beyond_three, 1);
}

TEST(MirrorCalibrationTest, ThreeParametersExplainAsMuchAsAFreeSecondCamera) {
  const NetworkScene scene = MirrorScene(5, 20);
  const auto found = CalibrateMirror(scene.board, SeeBoards(scene, 0.1, 11)[0], {}, {});
  ASSERT_TRUE(found) << found.error().message;
  AdjustOptions options;
  options.lenses = {FreedomOf(LensModel::kBrown5, {}), LensFreedom{}};
  const AdjustedNetwork free = Adjust(WithFreeSecondCamera(found->output), options);
  ASSERT_TRUE(free.converged) << free.solver_message;
  EXPECT_LT(found->output.rms_px(), 1.05 * free.rms_px());
  EXPECT_GT(found->output.rms_px(), 0.95 * free.rms_px());
}

// Residuals hardly tell that there is glass: the lens' axis and the plane give way. But they are
// wrong then, which is why the thickness has to be said.
TEST(MirrorCalibrationTest, GlassThatIsNotSaidMovesTheMirror) {
  const NetworkScene scene = MirrorScene(3, 20, 5);
  const CameraSightings seen = SeeBoards(scene, 0.02, 7)[0];
  MirrorOptions glass;
  glass.glass_mm = 5;
  const auto with = CalibrateMirror(scene.board, seen, {}, glass);
  const auto without = CalibrateMirror(scene.board, seen, {}, {});
  ASSERT_TRUE(with && without);
  const Mirror& truth = scene.array.mirrors[0];
  EXPECT_NEAR(with->output.rms_px(), 0.02 * std::sqrt(2.0), 0.002);
  ExpectSameMirror(with->output.array.mirrors[0], truth, 1e-3, 0.5);
  const Mirror& wrong = without->output.array.mirrors[0];
  EXPECT_GT(wrong.normal_in_stage.cross(truth.normal_in_stage).norm(), 2e-3);
}

// What the detector does where the board's image happens to be the larger one.
TEST(MirrorCalibrationTest, ViewsTakenForOneAnotherAreExchanged) {
  const NetworkScene scene = MirrorScene(4, 15);
  CameraSightings seen = SeeBoards(scene, 0.1, 4)[0];
  const int columns = 9, rows = 6;
  for (BoardSighting& sighting : seen.sightings) {
    if (sighting.frame != 3 && sighting.frame != 8) continue;
    // 9 x 6 corners read from the mirrored side are counted from the last row up.
    std::vector<Eigen::Vector2d> counted(sighting.points_px.size());
    for (int corner = 0; corner < rows * columns; ++corner)
      counted[(rows - 1 - corner / columns) * columns + corner % columns] =
          sighting.points_px[corner];
    sighting.points_px = counted;
    sighting.mirrored = !sighting.mirrored;
  }
  const auto found = CalibrateMirror(scene.board, seen, {}, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->output.sightings.size(), 30U);
  for (const Placement& placement : found->output.placements)
    EXPECT_LT(scene.array.mirrors[0].normal_in_stage.dot(placement.stage_from_board.translation_mm),
              scene.array.mirrors[0].distance_mm)
        << "behind the mirror";
  for (const SightingResult& sighting : found->output.sightings)
    EXPECT_TRUE(sighting.used) << sighting.source << ": " << sighting.reason;
  EXPECT_NEAR(found->output.sigma_px, 0.1, 0.01);
}

// Turned about the middle of what it shows, halfway through the pictures.
TEST(MirrorCalibrationTest, AMirrorThatMovedBetweenPicturesIsNotUsable) {
  for (double angle_rad : {0.02, 0.05}) {
    const NetworkScene scene = MirrorScene(6, 20);
    NetworkScene moved = scene;
    Mirror& mirror = moved.array.mirrors[0];
    mirror.normal_in_stage =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()) * mirror.normal_in_stage;
    mirror.distance_mm = mirror.normal_in_stage.dot(Eigen::Vector3d{150, 0, 800});
    CameraSightings seen = SeeBoards(scene, 0.05, 6)[0];
    std::erase_if(seen.sightings, [](const BoardSighting& s) { return s.frame >= 10; });
    const CameraSightings later = SeeBoards(moved, 0.05, 6)[0];
    for (const BoardSighting& sighting : later.sightings)
      if (sighting.frame >= 10) seen.sightings.push_back(sighting);
    const auto found = CalibrateMirror(scene.board, seen, {}, {});
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_FALSE(found->report.IsUsable()) << found->report.verdict;
    EXPECT_THAT(found->report.verdict, HasSubstr("did it move between pictures")) << angle_rad;
  }
}

TEST(MirrorCalibrationTest, TwoMirrorsAreToldApart) {
  NetworkScene scene = MirrorScene(2, 15);
  Mirror left = scene.array.mirrors[0];
  left.name = "left";
  // Below the board, tilted towards it.
  left.normal_in_stage = Eigen::Vector3d{0, std::sin(0.6), std::cos(0.6)};
  left.distance_mm = left.normal_in_stage.dot(Eigen::Vector3d{0, 140, 950});
  scene.array.mirrors.push_back(left);
  const CameraSightings seen = SeeBoards(scene, 0.05, 9)[0];
  MirrorOptions options;
  options.mirrors = 2;
  const auto found = CalibrateMirror(scene.board, seen, {}, options);
  ASSERT_TRUE(found) << found.error().message;
  const auto& mirrors = found->output.array.mirrors;
  ASSERT_EQ(mirrors.size(), 2U);
  const bool swapped =
      mirrors[0].normal_in_stage.dot(scene.array.mirrors[0].normal_in_stage) < 0.99;
  for (int i = 0; i < 2; ++i)
    ExpectSameMirror(mirrors[swapped ? 1 - i : i], scene.array.mirrors[i], 0.002, 1.0);
}

TEST(MirrorCalibrationTest, PicturesOfTheMirrorAloneAreUsedToo) {
  const NetworkScene scene = MirrorScene(4, 16);
  CameraSightings seen = SeeBoards(scene, 0.1, 3)[0];
  std::erase_if(seen.sightings, [](const BoardSighting& sighting) {
    return !sighting.mirrored && sighting.frame % 2 == 1;
  });
  const auto found = CalibrateMirror(scene.board, seen, {}, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->report.IsUsable()) << found->report.verdict;
  for (const SightingResult& sighting : found->output.sightings)
    EXPECT_TRUE(sighting.used) << sighting.reason;
}

TEST(MirrorCalibrationTest, MirrorsThatCannotBeAreRefused) {
  const NetworkScene scene = MirrorScene(4, 8);
  const CameraSightings seen = SeeBoards(scene, 0.1, 3)[0];
  const auto none = CalibrateMirror(scene.board, seen, {}, {.mirrors = 0});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("mirrors is 0"));
  const auto thin = CalibrateMirror(scene.board, seen, {}, {.glass_mm = -3});
  ASSERT_FALSE(thin);
  EXPECT_THAT(thin.error().message, HasSubstr("glass_mm"));
  EXPECT_FALSE(CalibrateMirror(scene.board, seen, {}, {.glass_mm = 3, .glass_index = 0.5}));
}

TEST(MirrorCalibrationTest, AMirrorThatShowsOnlyItselfIsRefused) {
  const NetworkScene scene = MirrorScene(1, 10);
  CameraSightings seen = SeeBoards(scene, 0.1, 1)[0];
  std::erase_if(seen.sightings, [](const BoardSighting& sighting) { return !sighting.mirrored; });
  const auto found = CalibrateMirror(scene.board, seen, {}, {});
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("0 of 10 pictures show the board both"));
}

}  // namespace
}  // namespace articap
