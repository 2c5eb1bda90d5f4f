// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "rig/default_head/face_shape.h"
#include "rig/default_head/half_mesh.h"
#include "rig/default_head/skin_layout.h"

namespace articap {

// The skin as part of a half mesh: vertex i is node i of the layout, and further rings follow those
// of the layout, inwards.
struct Skin {
  SkinLayout layout;
  // Like SkinLayout::mouth_rings, continued over the vermilion to the seam and round the mouth bag.
  // The seam ring holds the upper lip's vertices, the corner, and the lower lip's, at the same points.
  std::vector<std::vector<int>> mouth_rings;
  int border_ring = 0;
  int seam_ring = 0;
  // Like SkinLayout::eye_rings, continued over the lids' margin into the orbit.
  std::vector<std::vector<int>> eye_rings;
  int lid_ring = 0;

  int num_mouth_columns() const { return static_cast<int>(mouth_rings[0].size()); }
  // 0 on the midline, 1 at the corner of the mouth.
  double MouthFraction(int k) const;
  bool IsUpper(int k) const { return k < layout.mouth_corner; }
};

// Adds the skin to an empty half mesh.
Skin AddSkin(const FaceShape& shape, HalfMesh& half);

}  // namespace articap
