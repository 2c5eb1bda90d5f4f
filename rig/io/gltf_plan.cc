// SPDX-License-Identifier: MIT
#include "rig/io/gltf_plan.h"

namespace articap {
namespace {

bool IsJawParameter(const RigDefinition& rig, int parameter) {
  return rig.jaw &&
         (parameter == rig.jaw->rotation_parameter || parameter == rig.jaw->thrust_parameter ||
          parameter == rig.jaw->shift_parameter);
}

}  // namespace

std::vector<PartMesh> PartMeshes(const RigDefinition& rig) {
  std::vector<PartMesh> parts;
  for (std::size_t part = 0; part < rig.part_names.size(); ++part) {
    PartMesh mesh{rig.part_names[part], {}, {}};
    std::vector<int> new_index(rig.mesh.vertices.size(), -1);
    for (std::size_t i = 0; i < rig.mesh.triangles.size(); ++i) {
      if (rig.triangle_part[i] != part) continue;
      Eigen::Vector3i triangle = rig.mesh.triangles[i];
      for (int& corner : triangle) {
        int& index = new_index[corner];
        if (index < 0) {
          index = static_cast<int>(mesh.rig_vertex.size());
          mesh.rig_vertex.push_back(corner);
        }
        corner = index;
      }
      mesh.triangles.push_back(triangle);
    }
    if (!mesh.triangles.empty()) parts.push_back(std::move(mesh));
  }
  return parts;
}

TargetPlan PlanTargets(const FaceRig& rig) {
  TargetPlan plan;
  for (int i = 0; i < rig.num_parameters(); ++i) {
    if (IsJawParameter(rig.definition(), i) && rig.field(i).vertices.empty()) continue;
    const double max = rig.definition().parameters[i].max;
    plan.parameters.push_back(i);
    plan.scales.push_back(max > 0 ? max : 1);
  }
  return plan;
}

std::vector<float> TargetWeights(const TargetPlan& plan, const Eigen::VectorXd& parameters) {
  std::vector<float> weights;
  for (std::size_t i = 0; i < plan.parameters.size(); ++i)
    weights.push_back(static_cast<float>(parameters[plan.parameters[i]] / plan.scales[i]));
  return weights;
}

JawPose PoseJaw(const FaceRig& rig, const Eigen::VectorXd& parameters) {
  const JawJoint& jaw = *rig.definition().jaw;
  const auto value = [&](int index) { return index < 0 ? 0.0 : parameters[index]; };
  const Eigen::Vector3d position_mm = rig.neutral_mesh().vertices[jaw.pivot_vertex] +
                                      value(jaw.thrust_parameter) * jaw.thrust_direction +
                                      value(jaw.shift_parameter) * jaw.shift_direction;
  return {position_mm / kMetre_mm,
          Eigen::Quaterniond(Eigen::AngleAxisd(value(jaw.rotation_parameter), jaw.axis))};
}

}  // namespace articap
