// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/frame_source.h"
#include "render/picture.h"
#include "tracking/take_marks.h"

namespace articap {

// A part of a frame as the camera's picture, in colour: square pixels, every row
// (PictureFromImage), the nearest pixel of the file for each; what lies beyond the image is dark
// grey.
Picture PictureOf(const Frame& frame, int left, int top, int width, int height);

// How a part of a camera's picture is shown: from (left, top) on, every pixel `zoom` times as
// large.
struct Magnification {
  int left = 0;
  int top = 0;
  int zoom = 1;

  Eigen::Vector2d operator()(const Eigen::Vector2d& point_px) const {
    return zoom * (point_px - Eigen::Vector2d(left, top)) +
           Eigen::Vector2d::Constant((zoom - 1) / 2.0);
  }
};

struct MarkStyle {
  std::vector<std::string> names;  // of the markers
  std::vector<int> highlighted;    // markers
  int text_scale = 1;
  bool crosses_in_rings = false;  // also of dots that were found: where the marker is
};

// Draws what was found in the picture of a camera: a ring around every dot, blue with the marker's
// name, grey where it is none's; a cross where a marker is hidden; highlighted markers in orange.
// Names keep off one another; a line leads to those that had to move away.
void DrawMarks(const FrameMarks& marks, int camera, const Magnification& shown,
               const MarkStyle& style, Picture& picture);

}  // namespace articap
