// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/board.h"
#include "core/transforms.h"
#include "synthetic/studio.h"

namespace articap {

// The board in the studio's light.
Scene BoardScene(const Studio& studio, const BoardPattern& pattern,
                 const Rigid3d& stage_from_board);

// What every view shows of a board.
struct BoardTruth {
  ViewTruth corners;   // in the order of their numbers
  bool whole = false;  // all squares are to be seen, from their front
};

std::vector<BoardTruth> TruthOfBoard(const Studio& studio, const BoardSpec& board,
                                     const BoardPattern& pattern, const Rigid3d& stage_from_board);

// Where somebody who calibrates holds the board.
struct BoardPoseOptions {
  // The middle of the squares stays in a box.
  Eigen::Vector3d center_in_stage_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d reach_mm = Eigen::Vector3d(70, 50, 60);  // of the box, to each side
  // Towards whom the front looks on average; any length.
  Eigen::Vector3d facing_in_stage = Eigen::Vector3d::UnitZ();
  double most_tilt_deg = 40;  // from there
  double most_roll_deg = 30;  // within its plane
  int whole_in_views = 1;     // poses in which fewer views show the whole board are not taken
};

// Fails where hardly any pose is seen by enough views.
Result<std::vector<Rigid3d>> RandomBoardPoses(const Studio& studio, const BoardSpec& board,
                                              const BoardPattern& pattern,
                                              const BoardPoseOptions& options, int num_poses,
                                              std::uint64_t seed);

}  // namespace articap
