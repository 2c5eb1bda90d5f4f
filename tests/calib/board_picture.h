// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/board.h"
#include "core/camera.h"
#include "core/image.h"

namespace articap {

// Where a board is before a camera; mm, camera frame.
struct BoardPose {
  Eigen::Vector3d middle_mm = Eigen::Vector3d(0, 0, 600);  // of the corners
  // Directions of the board's rows and columns, unit. Left-handed with the line of sight: as a
  // mirror shows it.
  Eigen::Vector3d x_axis = Eigen::Vector3d::UnitX();
  Eigen::Vector3d y_axis = Eigen::Vector3d::UnitY();

  // Turned about the camera's x axis, then its y axis, then the line of sight.
  static BoardPose Turned(double pitch_rad, double yaw_rad, double roll_rad);
  // With its rows the other way round.
  BoardPose Reversed() const;

  Eigen::Vector3d InCamera(const BoardSpec& board, const Eigen::Vector2d& board_mm) const;
};

// How a picture of boards comes about.
struct BoardPictureOptions {
  int width = 640;
  int height = 480;
  Lens lens = {.fx_px = 800, .fy_px = 800, .cx_px = 319.5, .cy_px = 239.5};
  double black = 0.1;   // ink
  double white = 0.8;   // paper
  double ground = 0.4;  // behind the paper
  double exposure = 1;  // factor on the light; what comes above 1 saturates
  // The light falls by this part of itself from the left side of the picture to the right.
  double falloff = 0;
  double blur_px = 0.6;   // SD of the Gaussian over the pixels' squares
  double noise = 0;       // SD of white noise
  bool quantized = true;  // to 8 bits; else the 16 bits of the picture are used
  std::uint64_t seed = 1;
};

// Boards of one kind, the later before the earlier, each pixel the mean over its square.
Image PictureOf(const BoardSpec& board, const std::vector<BoardPose>& poses,
                const BoardPictureOptions& options);
Image PictureOf(const BoardSpec& board, const BoardPose& pose, const BoardPictureOptions& options);

// Where the corners of the board truly are in it, px.
std::vector<Eigen::Vector2d> TrueCorners(const BoardSpec& board, const BoardPose& pose,
                                         const BoardPictureOptions& options);

}  // namespace articap
