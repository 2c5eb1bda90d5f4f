// SPDX-License-Identifier: MIT
#include "rig/io/gltf_import.h"

#include <algorithm>

#include "core/file_io.h"

namespace articap {
namespace {

int IndexOfGroup(const std::string& name, std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

DisplacementField& FieldOf(const std::string& name, MorphSource& source) {
  const auto found =
      std::find_if(source.targets.begin(), source.targets.end(),
                   [&](const MorphSource::Target& target) { return target.name == name; });
  if (found != source.targets.end()) return found->field;
  source.targets.push_back({name, {}});
  return source.targets.back().field;
}

void AppendPrimitive(const GltfModel& model, int node, const GltfModel::Primitive& primitive,
                     MorphSource& source) {
  const GltfModel::Mesh& mesh = model.meshes[model.nodes[node].mesh];
  const int first = static_cast<int>(source.vertices.size());
  const int group =
      IndexOfGroup(primitive.material.empty() ? mesh.name : primitive.material, source.group_names);
  std::vector<Eigen::Matrix3d> linear;
  for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
    const Eigen::Matrix4d scene_from_vertex =
        SceneFromVertex(model, node, primitive, i).cast<double>();
    linear.emplace_back(scene_from_vertex.topLeftCorner<3, 3>());
    source.vertices.emplace_back(linear.back() * primitive.positions[i].cast<double>() +
                                 scene_from_vertex.topRightCorner<3, 1>());
  }
  source.colors.insert(source.colors.end(), primitive.colors.begin(), primitive.colors.end());
  for (const Eigen::Vector3i& triangle : primitive.triangles) {
    source.triangles.emplace_back(triangle + Eigen::Vector3i::Constant(first));
    source.triangle_group.push_back(group);
  }
  for (std::size_t target = 0; target < primitive.targets.size(); ++target) {
    DisplacementField& field = FieldOf(mesh.target_names[target], source);
    for (std::size_t i = 0; i < primitive.targets[target].size(); ++i) {
      const Eigen::Vector3f& displacement = primitive.targets[target][i];
      if (displacement.isZero(0)) continue;
      field.vertices.push_back(first + static_cast<int>(i));
      field.displacements_mm.emplace_back(linear[i] * displacement.cast<double>());
    }
  }
}

}  // namespace

MorphSource MorphSourceOf(const GltfModel& model, const std::string& name) {
  MorphSource source;
  source.name = name;
  source.mm_per_unit = 1000;
  for (const int node : model.mesh_nodes)
    for (const GltfModel::Primitive& primitive : model.meshes[model.nodes[node].mesh].primitives)
      AppendPrimitive(model, node, primitive, source);
  return source;
}

Result<MorphSource> ReadGltfTargets(const std::filesystem::path& path) {
  const auto bytes = ReadFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto model =
      ParseGltf(*bytes, path.string(), std::filesystem::absolute(path).parent_path());
  if (!model) return tl::unexpected(model.error());
  return MorphSourceOf(*model, path.stem().string());
}

}  // namespace articap
