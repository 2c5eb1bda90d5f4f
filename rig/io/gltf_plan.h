// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "rig/face_rig.h"

namespace articap {

// What a rig becomes in glTF: shared by the writer and by the comparison of its files with the rig.

constexpr double kMetre_mm = 1000;

// One part of the rig with vertices of its own.
struct PartMesh {
  std::string name;
  std::vector<int> rig_vertex;  // of each vertex
  std::vector<Eigen::Vector3i> triangles;
};
std::vector<PartMesh> PartMeshes(const RigDefinition& rig);

// The parameters that become morph targets: all but the jaw's own, and those of the jaw's that move
// vertices besides.
struct TargetPlan {
  std::vector<int> parameters;
  std::vector<double> scales;  // value of the parameter at weight 1
};
TargetPlan PlanTargets(const FaceRig& rig);
std::vector<float> TargetWeights(const TargetPlan& plan, const Eigen::VectorXd& parameters);

// Translation (metres) and rotation of the jaw's node in a pose; of rigs with a jaw joint alone.
struct JawPose {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
JawPose PoseJaw(const FaceRig& rig, const Eigen::VectorXd& parameters);

}  // namespace articap
