// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "rig/default_head/face_shape.h"
#include "rig/default_head/half_mesh.h"
#include "rig/default_head/mouth_parts.h"
#include "rig/default_head/skin.h"
#include "rig/face_rig.h"

namespace articap {

// A landmark on the speaker's left half. Those off the midline get a partner on the right.
struct HalfLandmark {
  std::string name;   // on the midline, or with {} where left or right stands
  int vertex = 0;
};

// Vertices that other parts know.
struct KnownVertices {
  Incisors incisors;
  int eye_center = 0;
  std::array<int, 3> spectacles = {};
  int jaw_pivot = 0;
  int mouth_pivot = 0;
};

// The vocabulary of docs/landmarks.md on the half mesh.
std::vector<HalfLandmark> FindLandmarks(const HalfMesh& half, const Skin& skin,
                                        const FaceShape& shape, const KnownVertices& known);

// The same on the whole head.
std::vector<Landmark> MirrorLandmarks(const std::vector<HalfLandmark>& half, const MirrorMap& map);

}  // namespace articap
