// SPDX-License-Identifier: MIT
#include "rig/io/gltf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

#include "rig/io/gltf_accessor.h"

namespace articap {
namespace {

struct RefusedExtension {
  const char* name;
  const char* what;
};
constexpr RefusedExtension kRefusedExtensions[] = {
    {"KHR_draco_mesh_compression", "compressed with Draco"},
    {"EXT_meshopt_compression", "compressed with meshopt"},
    {"KHR_meshopt_compression", "compressed with meshopt"},
    {"KHR_mesh_quantization", "quantised"},
};

std::vector<Eigen::Vector3i> ReadTriangles(const tinygltf::Model& model,
                                           const tinygltf::Primitive& primitive,
                                           std::size_t num_vertices) {
  std::vector<int> corners;
  if (primitive.indices < 0) {
    for (std::size_t i = 0; i < num_vertices; ++i) corners.push_back(static_cast<int>(i));
  } else {
    const ElementReader reader(model, primitive.indices, "indices");
    Require(reader.components() == 1 && reader.component_type() != TINYGLTF_COMPONENT_TYPE_FLOAT,
            "indices: not a list of whole numbers");
    for (std::size_t i = 0; i < reader.count(); ++i) {
      const double corner = reader.Value(i, 0);
      Require(corner < static_cast<double>(num_vertices), "indices: {} names vertex {} of {}", i,
              corner, num_vertices);
      corners.push_back(static_cast<int>(corner));
    }
  }
  Require(corners.size() % 3 == 0, "indices: {} are not a multiple of three", corners.size());
  std::vector<Eigen::Vector3i> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
  return triangles;
}

int FindAttribute(const std::map<std::string, int>& attributes, const char* name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

Eigen::Vector3f MaterialColor(const tinygltf::Model& model, int material) {
  if (!IsIndex(material, model.materials.size())) return Eigen::Vector3f::Constant(0.6f);
  const std::vector<double>& factor =
      model.materials[material].pbrMetallicRoughness.baseColorFactor;
  if (factor.size() < 3) return Eigen::Vector3f::Ones();
  return Eigen::Vector3d(factor[0], factor[1], factor[2]).cwiseMax(0.0).cwiseMin(1.0).cast<float>();
}

void ReadColors(const tinygltf::Model& model, const tinygltf::Primitive& source,
                GltfModel::Primitive& primitive) {
  const Eigen::Vector3f factor = MaterialColor(model, source.material);
  primitive.colors.assign(primitive.positions.size(), factor);
  const int index = FindAttribute(source.attributes, "COLOR_0");
  if (index < 0) return;
  const ElementReader reader(model, index, "COLOR_0");
  Require(reader.components() >= 3 && reader.count() == primitive.positions.size(),
          "COLOR_0: not a colour for each vertex");
  for (std::size_t i = 0; i < reader.count(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double value = reader.Value(i, static_cast<std::size_t>(k));
      Require(std::isfinite(value), "COLOR_0: element {} is not finite", i);
      primitive.colors[i][k] *= static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
}

void ReadSkinning(const tinygltf::Model& model, const tinygltf::Primitive& source,
                  GltfModel::Primitive& primitive) {
  const int joints = FindAttribute(source.attributes, "JOINTS_0");
  const int weights = FindAttribute(source.attributes, "WEIGHTS_0");
  if (joints < 0 || weights < 0) return;
  Require(FindAttribute(source.attributes, "JOINTS_1") < 0,
          "JOINTS_1: more than four joints a vertex; limit them to four on export");
  const ElementReader joint_reader(model, joints, "JOINTS_0");
  const ElementReader weight_reader(model, weights, "WEIGHTS_0");
  Require(joint_reader.components() == 4 && weight_reader.components() == 4 &&
              joint_reader.count() == primitive.positions.size() &&
              weight_reader.count() == primitive.positions.size(),
          "JOINTS_0, WEIGHTS_0: not four for each vertex");
  for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
    std::array<int, 4> joint{};
    Eigen::Vector4f weight;
    for (int k = 0; k < 4; ++k) {
      const double index = joint_reader.Value(i, static_cast<std::size_t>(k));
      Require(index >= 0 && index < 65536, "JOINTS_0: element {} is no joint", i);
      joint[static_cast<std::size_t>(k)] = static_cast<int>(index);
      weight[k] = static_cast<float>(weight_reader.Value(i, static_cast<std::size_t>(k)));
      Require(std::isfinite(weight[k]), "WEIGHTS_0: element {} is not finite", i);
    }
    primitive.joints.push_back(joint);
    primitive.weights.push_back(weight);
  }
}

GltfModel::Primitive ReadPrimitive(const tinygltf::Model& model,
                                   const tinygltf::Primitive& source) {
  Require(source.mode == TINYGLTF_MODE_TRIANGLES || source.mode == -1,
          "a primitive is made of points, lines or strips; export triangles");
  GltfModel::Primitive primitive;
  if (IsIndex(source.material, model.materials.size()))
    primitive.material = model.materials[source.material].name;
  primitive.positions =
      ReadVectors(model, FindAttribute(source.attributes, "POSITION"), "POSITION");
  primitive.triangles = ReadTriangles(model, source, primitive.positions.size());
  ReadColors(model, source, primitive);
  ReadSkinning(model, source, primitive);
  for (const std::map<std::string, int>& target : source.targets) {
    const int index = FindAttribute(target, "POSITION");
    primitive.targets.push_back(index < 0 ? std::vector<Eigen::Vector3f>{}
                                          : ReadVectors(model, index, "morph target POSITION"));
    Require(index < 0 || primitive.targets.back().size() == primitive.positions.size(),
            "a morph target moves {} vertices of {}", primitive.targets.back().size(),
            primitive.positions.size());
  }
  return primitive;
}

std::vector<std::string> TargetNames(const tinygltf::Mesh& mesh) {
  std::size_t count = 0;
  for (const tinygltf::Primitive& primitive : mesh.primitives)
    count = std::max(count, primitive.targets.size());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("target_{}", i));
  if (!mesh.extras.IsObject() || !mesh.extras.Has("targetNames")) return names;
  const tinygltf::Value& given = mesh.extras.Get("targetNames");
  if (!given.IsArray()) return names;
  for (std::size_t i = 0; i < std::min(count, given.ArrayLen()); ++i)
    if (given.Get(static_cast<int>(i)).IsString())
      names[i] = given.Get(static_cast<int>(i)).Get<std::string>();
  return names;
}

Eigen::Affine3f LocalTransform(const tinygltf::Node& node) {
  Eigen::Affine3f local = Eigen::Affine3f::Identity();
  if (node.matrix.size() == 16) {
    local.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()).cast<float>();
  } else {
    if (node.translation.size() == 3)
      local.translate(Eigen::Map<const Eigen::Vector3d>(node.translation.data()).cast<float>());
    if (node.rotation.size() == 4)  // x y z w
      local.rotate(
          Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])
              .normalized()
              .cast<float>());
    if (node.scale.size() == 3)
      local.scale(Eigen::Map<const Eigen::Vector3d>(node.scale.data()).cast<float>());
  }
  Require(local.matrix().allFinite(), "node '{}' has a transform that is not finite", node.name);
  return local;
}

void ReadNodes(const tinygltf::Model& source, GltfModel& model) {
  for (const tinygltf::Node& node : source.nodes) {
    Require(node.mesh < 0 || IsIndex(node.mesh, source.meshes.size()),
            "node '{}' draws mesh {}, which does not exist", node.name, node.mesh);
    Require(node.skin < 0 || IsIndex(node.skin, source.skins.size()),
            "node '{}' has skin {}, which does not exist", node.name, node.skin);
    model.nodes.push_back({node.name, -1, LocalTransform(node), node.mesh, node.skin});
  }
  for (std::size_t i = 0; i < source.nodes.size(); ++i)
    for (const int child : source.nodes[i].children) {
      Require(IsIndex(child, model.nodes.size()), "node {} has the child {}, which does not exist",
              i, child);
      Require(model.nodes[child].parent < 0, "node {} has two parents", child);
      model.nodes[child].parent = static_cast<int>(i);
    }
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    std::size_t steps = 0;
    for (int at = static_cast<int>(i); at >= 0; at = model.nodes[at].parent)
      Require(++steps <= model.nodes.size(), "the nodes form a circle");
    if (model.nodes[i].mesh >= 0) model.mesh_nodes.push_back(static_cast<int>(i));
  }
}

void ReadSkins(const tinygltf::Model& source, GltfModel& model) {
  for (const tinygltf::Skin& skin : source.skins) {
    GltfModel::Skin read;
    for (const int joint : skin.joints)
      Require(IsIndex(joint, model.nodes.size()), "a skin names node {}, which does not exist",
              joint);
    read.joints = skin.joints;
    read.inverse_bind.assign(skin.joints.size(), Eigen::Matrix4f::Identity());
    if (skin.inverseBindMatrices >= 0) {
      const std::vector<float> values =
          ReadFloats(source, skin.inverseBindMatrices, "inverseBindMatrices");
      Require(values.size() >= 16 * skin.joints.size(),
              "inverseBindMatrices: {} numbers for {} joints", values.size(), skin.joints.size());
      for (std::size_t i = 0; i < skin.joints.size(); ++i)
        read.inverse_bind[i] = Eigen::Map<const Eigen::Matrix4f>(&values[16 * i]);
    }
    model.skins.push_back(std::move(read));
  }
  for (const int node : model.mesh_nodes) {
    if (model.nodes[node].skin < 0) continue;
    const int num_joints = static_cast<int>(model.skins[model.nodes[node].skin].joints.size());
    for (const GltfModel::Primitive& primitive : model.meshes[model.nodes[node].mesh].primitives)
      for (std::size_t i = 0; i < primitive.joints.size(); ++i)
        for (int k = 0; k < 4; ++k)
          Require(primitive.weights[i][k] == 0 ||
                      primitive.joints[i][static_cast<std::size_t>(k)] < num_joints,
                  "JOINTS_0: element {} names a joint that the skin does not have", i);
  }
}

void ReadAnimations(const tinygltf::Model& source, GltfModel& model) {
  for (const tinygltf::Animation& animation : source.animations)
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (!IsIndex(channel.target_node, model.nodes.size())) continue;
      Require(IsIndex(channel.sampler, animation.samplers.size()),
              "an animation names sampler {}, which does not exist", channel.sampler);
      const tinygltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
      model.channels.push_back({channel.target_node, channel.target_path,
                                ReadFloats(source, sampler.input, "animation input"),
                                ReadFloats(source, sampler.output, "animation output")});
    }
}

GltfModel ReadModel(const tinygltf::Model& source) {
  for (const RefusedExtension& refused : kRefusedExtensions)
    for (const auto* list : {&source.extensionsUsed, &source.extensionsRequired})
      Require(
          std::find(list->begin(), list->end(), refused.name) == list->end(),
          "the file is {} ({}), which is not supported; export it again without compression and "
          "quantisation (in Blender: glTF export, Data, Compression off)",
          refused.what, refused.name);
  GltfModel model;
  std::size_t num_values = 0;
  for (const tinygltf::Mesh& mesh : source.meshes) {
    GltfModel::Mesh read{mesh.name, TargetNames(mesh), {}};
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      read.primitives.push_back(ReadPrimitive(source, primitive));
      const GltfModel::Primitive& last = read.primitives.back();
      num_values += last.positions.size() * (1 + last.targets.size()) + last.triangles.size();
      Require(num_values <= 50 * kMaxElements, "the meshes are too large for a head");
    }
    model.meshes.push_back(std::move(read));
  }
  ReadNodes(source, model);
  ReadSkins(source, model);
  ReadAnimations(source, model);
  Require(!model.mesh_nodes.empty(), "no node of the file draws a mesh");
  return model;
}

bool LoadNoImage(tinygltf::Image*, const int, std::string*, std::string*, int, int,
                 const unsigned char*, int, void*) {
  return true;  // pictures play no part in a rig
}

// A file on its own refers to no other files.
tinygltf::FsCallbacks NoFiles() {
  tinygltf::FsCallbacks callbacks;
  callbacks.FileExists = [](const std::string&, void*) { return false; };
  callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&,
                               void*) { return false; };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                void*) { return false; };
  callbacks.user_data = nullptr;
  return callbacks;
}

Eigen::Matrix4f SceneFromNode(const GltfModel& model, int node) {
  Eigen::Matrix4f scene_from_node = Eigen::Matrix4f::Identity();
  for (; node >= 0; node = model.nodes[node].parent)
    scene_from_node = model.nodes[node].parent_from_node.matrix() * scene_from_node;
  return scene_from_node;
}

}  // namespace

Result<GltfModel> ParseGltf(std::string_view bytes, const std::string& source,
                            const std::optional<std::filesystem::path>& folder) {
  try {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(LoadNoImage, nullptr);
    if (!folder) loader.SetFsCallbacks(NoFiles());
    const std::string base = folder ? folder->string() : "";
    tinygltf::Model model;
    std::string error, warning;
    const auto size = static_cast<unsigned>(bytes.size());
    const bool loaded =
        bytes.starts_with("glTF")
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          size, base)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, base);
    if (!loaded) {
      while (!error.empty() && std::isspace(static_cast<unsigned char>(error.back())))
        error.pop_back();
      return Fail(fmt::format("{}: not a glTF 2.0 file that can be read: {}", source, error));
    }
    return ReadModel(model);
  } catch (const std::exception& exception) {
    return Fail(fmt::format("{}: {}", source, exception.what()));
  }
}

Eigen::Matrix4f SceneFromVertex(const GltfModel& model, int mesh_node,
                                const GltfModel::Primitive& primitive, std::size_t vertex) {
  const GltfModel::Node& node = model.nodes[mesh_node];
  if (node.skin < 0 || primitive.joints.empty()) return SceneFromNode(model, mesh_node);
  const GltfModel::Skin& skin = model.skins[node.skin];
  Eigen::Matrix4f blend = Eigen::Matrix4f::Zero();
  for (int k = 0; k < 4; ++k) {
    const float weight = primitive.weights[vertex][k];
    if (weight == 0) continue;
    const int joint = primitive.joints[vertex][static_cast<std::size_t>(k)];
    blend += weight * (SceneFromNode(model, skin.joints[joint]) * skin.inverse_bind[joint]);
  }
  return blend;
}

std::vector<Eigen::Vector3f> EvaluatePrimitive(const GltfModel& model, int mesh_node,
                                               const GltfModel::Primitive& primitive,
                                               const std::vector<float>& target_weights) {
  std::vector<Eigen::Vector3f> positions = primitive.positions;
  for (std::size_t target = 0; target < primitive.targets.size(); ++target)
    for (std::size_t i = 0; i < primitive.targets[target].size(); ++i)
      positions[i] += target_weights[target] * primitive.targets[target][i];
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Matrix4f scene_from_vertex = SceneFromVertex(model, mesh_node, primitive, i);
    positions[i] = (scene_from_vertex * positions[i].homogeneous()).head<3>();
  }
  return positions;
}

}  // namespace articap
