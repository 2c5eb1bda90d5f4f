// SPDX-License-Identifier: MIT
#include "synthetic/board_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "render/shapes.h"
#include "synthetic/random.h"
#include "synthetic/random_streams.h"

namespace articap {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

// The corners of all that is dark: where they are seen, all is.
std::vector<Eigen::Vector3d> DarkCorners(const BoardPattern& pattern,
                                         const Rigid3d& stage_from_board) {
  std::vector<Eigen::Vector3d> corners;
  for (const BoardRectangle& dark : pattern.dark)
    for (const double x : {dark.min_mm.x(), dark.max_mm.x()})
      for (const double y : {dark.min_mm.y(), dark.max_mm.y()})
        corners.push_back(stage_from_board * Eigen::Vector3d(x, y, 0));
  return corners;
}

// Upright, with its front (its -z) towards `facing`.
Eigen::Quaterniond UprightBoard(const Eigen::Vector3d& facing) {
  const Eigen::Vector3d into = -facing.normalized();
  const Eigen::Vector3d right = into.cross(Eigen::Vector3d::UnitY()).normalized();
  Eigen::Matrix3d stage_from_board;
  stage_from_board << right, into.cross(right), into;
  return Eigen::Quaterniond(stage_from_board);
}

Rigid3d RandomPose(const BoardSpec& board, const BoardPoseOptions& options,
                   RandomGenerator& random) {
  const double x = random.Uniform(-1, 1);
  const double y = random.Uniform(-1, 1);
  const double z = random.Uniform(-1, 1);
  const double tilt_rad = random.Uniform(0, options.most_tilt_deg) * kRadPerDeg;
  const double tilt_towards_rad = random.Uniform(0, 2 * std::numbers::pi);
  const double roll_rad = random.Uniform(-1, 1) * options.most_roll_deg * kRadPerDeg;
  const Eigen::Vector3d tilt_axis(std::cos(tilt_towards_rad), std::sin(tilt_towards_rad), 0);
  const Eigen::Quaterniond rotation = UprightBoard(options.facing_in_stage) *
                                      Eigen::AngleAxisd(tilt_rad, tilt_axis) *
                                      Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d middle_in_board = 0.5 * board.corner_in_board_mm(board.num_corners() - 1);
  const Eigen::Vector3d middle_in_stage =
      options.center_in_stage_mm + options.reach_mm.cwiseProduct(Eigen::Vector3d(x, y, z));
  return {rotation, middle_in_stage - rotation * middle_in_board};
}

}  // namespace

Scene BoardScene(const Studio& studio, const BoardPattern& pattern,
                 const Rigid3d& stage_from_board) {
  Scene scene = studio.EmptyScene();
  scene.meshes = {BoardMesh(pattern, stage_from_board)};
  return scene;
}

std::vector<BoardTruth> TruthOfBoard(const Studio& studio, const BoardSpec& board,
                                     const BoardPattern& pattern, const Rigid3d& stage_from_board) {
  const Scene scene = BoardScene(studio, pattern, stage_from_board);
  std::vector<Eigen::Vector3d> corners;
  for (int corner = 0; corner < board.num_corners(); ++corner)
    corners.push_back(stage_from_board * board.corner_in_board_mm(corner));
  const std::vector<ViewTruth> of_corners = studio.TruthOf(scene, corners);
  const std::vector<ViewTruth> of_dark =
      studio.TruthOf(scene, DarkCorners(pattern, stage_from_board));
  std::vector<BoardTruth> truths;
  for (std::size_t view = 0; view < of_corners.size(); ++view)
    truths.push_back({of_corners[view], of_dark[view].all_visible()});
  return truths;
}

Result<std::vector<Rigid3d>> RandomBoardPoses(const Studio& studio, const BoardSpec& board,
                                              const BoardPattern& pattern,
                                              const BoardPoseOptions& options, int num_poses,
                                              std::uint64_t seed) {
  constexpr int kTriesForOne = 100;
  RandomGenerator random(seed, random_streams::kBoardPoses);
  std::vector<Rigid3d> poses;
  for (int tries = 0; static_cast<int>(poses.size()) < num_poses; ++tries) {
    if (tries >= kTriesForOne * num_poses)
      return Fail(
          fmt::format("of {} ways to hold {} only {} show all of it in {} views; hold it elsewhere",
                      tries, NameOf(board), poses.size(), options.whole_in_views));
    const Rigid3d pose = RandomPose(board, options, random);
    const std::vector<BoardTruth> truths = TruthOfBoard(studio, board, pattern, pose);
    const auto whole = std::count_if(truths.begin(), truths.end(),
                                     [](const BoardTruth& truth) { return truth.whole; });
    if (whole >= options.whole_in_views) poses.push_back(pose);
  }
  return poses;
}

}  // namespace articap
