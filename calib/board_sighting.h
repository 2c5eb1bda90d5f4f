// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"

namespace articap {

// The corners of a board as one picture shows them, directly or in a mirror.
struct BoardSighting {
  std::string source;      // what people find it by: "left02.jpg", "board.mp4, frame 312"
  std::int64_t frame = 0;  // index in its source
  SessionTime time;
  // The board appears reversed, as mirrors show it. Its corners keep their numbers all the same.
  bool mirrored = false;
  std::vector<int> corners;  // numbers of the board's corners (BoardSpec), ascending
  // Where each appears, in the picture's coordinates (core/frame_source.h), px.
  std::vector<Eigen::Vector2d> points_px;
};

}  // namespace articap
