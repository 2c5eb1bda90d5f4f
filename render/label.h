// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "render/picture.h"

namespace articap {

// Draws printable ASCII in a built-in 5x7 pixel face, each point `scale` pixels wide; what reaches
// over the edge is cut off. (x, y) is the top left corner of the first letter.
void DrawText(Picture& picture, std::string_view text, int x, int y, int scale,
              const Eigen::Vector3f& linear_color = Eigen::Vector3f::Zero());

// Width in pixels of a line of text.
int TextWidth(std::string_view text, int scale);

struct LabelledPicture {
  std::string label;
  Picture picture;
};

// Pictures side by side, `columns` to a row, each with its label underneath.
Picture ContactSheet(const std::vector<LabelledPicture>& pictures, int columns);

}  // namespace articap
