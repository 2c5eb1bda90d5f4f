// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rig/face_rig.h"

namespace articap {

// A mesh with morph targets as a file holds them: its own unit and axes, no meaning yet. What
// readers of OBJ folders, glTF and MakeHuman give to BuildMorphRig.
struct MorphSource {
  std::string name;
  double mm_per_unit = 0;  // 0: the format does not say
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3f> colors;  // linear RGB of every vertex, or empty
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> triangle_group;
  std::vector<std::string> group_names;
  struct Target {
    std::string name;
    DisplacementField field;  // in the file's unit and axes
  };
  std::vector<Target> targets;
};

}  // namespace articap
