// SPDX-License-Identifier: MIT
#include "calib/stage_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "calib/mirror_calibration.h"
#include "calib/rig_calibration.h"
#include "tests/calib/network_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;

TEST(StageFrameTest, PicturesStayTheSameInAnyStage) {
  CameraArray array = MirrorScene(1, 1).array;
  const Rigid3d new_from_old{Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized(), {50, -20, 300}};
  const Eigen::Vector3d point{-60, 20, 700};
  std::vector<Eigen::Vector2d> before;
  for (const View& view : array.views()) before.push_back(Project(array, view, point).value());
  MoveStage({}, {}, new_from_old, array);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((Project(array, array.views()[i], new_from_old * point).value() - before[i]).norm(),
              1e-9);
}

TEST(StageFrameTest, TheBoardOfAPictureBecomesTheStage) {
  const NetworkScene scene = RigScene(1, 2, 12);
  const auto rig = CalibrateRig(scene.board, SeeBoards(scene, 0, 1), {}, {});
  ASSERT_TRUE(rig) << rig.error().message;
  const auto stage = StageOfBoard(rig->output, "003.png");
  ASSERT_TRUE(stage) << stage.error().message;
  const Rigid3d& stage_from_board = scene.stage_from_board[3];
  EXPECT_LT((*stage * (stage_from_board * Eigen::Vector3d{0, 0, 0})).norm(), 0.01);
  const Eigen::Vector3d second = *stage * (stage_from_board * Eigen::Vector3d{20, 0, 0});
  EXPECT_LT((second - Eigen::Vector3d{20, 0, 0}).norm(), 0.01);
  const Eigen::Vector3d below = *stage * (stage_from_board * Eigen::Vector3d{0, 20, 0});
  EXPECT_LT((below - Eigen::Vector3d{0, -20, 0}).norm(), 0.01);
  const auto none = StageOfBoard(rig->output, "nowhere.png");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("nowhere.png"));
}

// With lenses that are known, what a camera shows best is where the board's volume lies before it:
// an error of its rotation is made up for by one of its place. In a stage with its origin there,
// that is the translation.
TEST(StageFrameTest, SigmasOfTranslationsFollowTheOrigin) {
  const NetworkScene scene = RigScene(2, 2, 20);
  std::vector<CameraSightings> seen = SeeBoards(scene, 0.1, 1);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i].lens = scene.array.cameras[i].lens;
  RigOptions held;
  held.adjust_lenses = false;
  const auto rig = CalibrateRig(scene.board, seen, {}, held);
  ASSERT_TRUE(rig) << rig.error().message;
  CameraArray array = rig->output.array;
  const Rigid3d new_from_old{Eigen::Quaterniond::Identity(), {0, 0, -800}};
  MoveStage(rig->output.parameters, rig->output.covariance, new_from_old, array);
  const CameraSigmas& before = rig->output.array.cameras[1].sigmas;
  const CameraSigmas& after = array.cameras[1].sigmas;
  EXPECT_TRUE(after.translation_mm.allFinite());
  EXPECT_EQ(after.rotation_rad, before.rotation_rad);
  EXPECT_LT(after.translation_mm.norm(), 0.5 * before.translation_mm.norm());
  EXPECT_EQ(array.cameras[0].sigmas.translation_mm, Eigen::Vector3d::Zero());
}

// From an origin far to the side the mirror's tilt tells, which hardly matters from the camera.
TEST(StageFrameTest, SigmasOfMirrorsFollowTheOrigin) {
  double squares = 0;
  constexpr int kSeeds = 12;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const NetworkScene scene = MirrorScene(seed, 15);
    CameraSightings seen = SeeBoards(scene, 0.1, 20 + seed)[0];
    seen.lens = scene.array.cameras[0].lens;
    const auto found = CalibrateMirror(scene.board, seen, {}, {.adjust_lens = false});
    ASSERT_TRUE(found) << found.error().message;
    CameraArray array = found->output.array, truth = scene.array;
    const Rigid3d new_from_old{Eigen::Quaterniond::Identity(), {1500, 0, -800}};
    MoveStage(found->output.parameters, found->output.covariance, new_from_old, array);
    MoveStage({}, {}, new_from_old, truth);
    EXPECT_GT(array.mirrors[0].distance_sigma_mm,
              1.2 * found->output.array.mirrors[0].distance_sigma_mm);
    squares += std::pow((array.mirrors[0].distance_mm - truth.mirrors[0].distance_mm) /
                            array.mirrors[0].distance_sigma_mm,
                        2);
  }
  EXPECT_NEAR(squares / kSeeds, 1, 3 * std::sqrt(2.0 / kSeeds));
}

std::vector<std::vector<Eigen::Vector2d>> SeePoints(const CameraArray& array,
                                                    const std::vector<Eigen::Vector3d>& points) {
  std::vector<std::vector<Eigen::Vector2d>> seen;
  for (int i = 0; i < static_cast<int>(array.cameras.size()); ++i) {
    seen.emplace_back();
    // Each camera counts them in its own order.
    for (std::size_t k = 0; k < points.size(); ++k)
      seen.back().push_back(Project(array, {i, -1}, points[(k + i) % points.size()]).value());
  }
  return seen;
}

TEST(StageFrameTest, AnLFrameGivesOriginAndAxes) {
  const CameraArray array = RigScene(3, 4, 1).array;
  const Rigid3d stage_from_l{Eigen::Quaterniond(0.8, 0.3, -0.2, 0.4).normalized(), {30, 40, 810}};
  const std::vector<Eigen::Vector3d> markers = {stage_from_l * Eigen::Vector3d{0, 0, 0},
                                                stage_from_l * Eigen::Vector3d{150, 0, 0},
                                                stage_from_l * Eigen::Vector3d{0, 90, 0}};
  const auto stage = StageOfLFrame(array, SeePoints(array, markers), {150, 90});
  ASSERT_TRUE(stage) << stage.error().message;
  EXPECT_NEAR(stage->long_found_mm, 150, 1e-6);
  EXPECT_NEAR(stage->angle_found_rad, M_PI / 2, 1e-8);
  EXPECT_LT((stage->new_from_old * markers[1] - Eigen::Vector3d{150, 0, 0}).norm(), 1e-6);
  EXPECT_LT((stage->new_from_old * markers[2] - Eigen::Vector3d{0, 90, 0}).norm(), 1e-6);

  const auto wrong = StageOfLFrame(array, SeePoints(array, markers), {200, 90});
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("arms of 150.0 and 90.0 mm where 200 and 90"));
}

}  // namespace
}  // namespace articap
