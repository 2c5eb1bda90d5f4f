// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "rig/default_head/base_surface.h"

namespace articap {

// Where the vertices of the left half of the skin lie on the base surface. A grid of columns (from the
// midline of the face to that of the back) and rows (from the neck to the crown) has two holes, and
// rings of quads lead from each hole's edge inwards: to the vermilion border and to the lids' margin.
struct SkinLayout {
  int num_columns = 0;
  int num_rows = 0;
  std::vector<int> grid;                           // node of each column and row; -1 in a hole
  std::vector<Eigen::Vector2d> nodes;              // section and level
  // [ring][k], from the hole's edge inwards. Mouth: k runs from the upper lip's midline over the
  // corner (k = mouth_corner) to the lower lip's midline. Eye: closed, from the inner corner along
  // the lower lid to the outer corner (k = eye_outer) and back along the upper lid.
  std::vector<std::vector<int>> mouth_rings;
  std::vector<std::vector<int>> eye_rings;
  int mouth_corner = 0;
  int eye_outer = 0;

  int At(int column, int row) const { return grid[row * num_columns + column]; }
};

// Relaxes the grid and the rings so that the last mouth ring is the vermilion border and the last eye
// ring the margin of the lids.
SkinLayout MakeSkinLayout(const BaseSurface& surface);

}  // namespace articap
