// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "render/picture.h"

namespace articap {

// Marks on pictures that people look at; what reaches over the edge is cut off. Places are px, the
// centre of the top left pixel at (0, 0); widths are those of the lines. The edges are smooth.

void DrawLine(Picture& picture, const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
              double width_px, const Eigen::Vector3f& linear_color);
void DrawRing(Picture& picture, const Eigen::Vector2d& center_px, double radius_px, double width_px,
              const Eigen::Vector3f& linear_color);
// A diagonal cross whose arms reach `radius_px` far.
void DrawCross(Picture& picture, const Eigen::Vector2d& center_px, double radius_px,
               double width_px, const Eigen::Vector3f& linear_color);
// Text (render/label.h) with a dark edge, readable on whatever is there.
void DrawEdgedText(Picture& picture, std::string_view text, int x, int y, int scale,
                   const Eigen::Vector3f& linear_color);

// Every pixel as a square of `zoom` pixels.
Picture Enlarged(const Picture& picture, int zoom);

// `part`, its top left corner at (left, top); what reaches over the edge is cut off.
void Paste(Picture& picture, const Picture& part, int left, int top);

}  // namespace articap
