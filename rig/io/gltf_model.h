// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace articap {

// What articap needs of a glTF 2.0 file, decoded and checked: every index is valid. Metres, float32
// as in the file.
struct GltfModel {
  struct Primitive {
    std::string material;
    std::vector<Eigen::Vector3f> positions;
    std::vector<Eigen::Vector3f> colors;  // linear RGB, of every vertex
    std::vector<Eigen::Vector3i> triangles;
    std::vector<std::vector<Eigen::Vector3f>>
        targets;                             // displacements; empty where a target has none
    std::vector<std::array<int, 4>> joints;  // indices into the skin, or empty
    std::vector<Eigen::Vector4f> weights;
  };
  struct Mesh {
    std::string name;
    std::vector<std::string> target_names;
    std::vector<Primitive> primitives;
  };
  struct Node {
    std::string name;
    int parent = -1;
    Eigen::Affine3f parent_from_node = Eigen::Affine3f::Identity();
    int mesh = -1;
    int skin = -1;
  };
  struct Skin {
    std::vector<int> joints;  // nodes
    std::vector<Eigen::Matrix4f> inverse_bind;
  };
  struct Channel {
    int node = 0;
    std::string path;  // "weights", "translation", "rotation", "scale"
    std::vector<float> times_s;
    std::vector<float> values;
  };
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<Skin> skins;
  std::vector<Channel> channels;  // of all animations
  std::vector<int> mesh_nodes;    // nodes of the scene that draw a mesh
};

// .gltf (JSON) or .glb; `folder` is where the files it refers to lie, nothing for a file on its
// own. Refuses what would need a decoder (Draco, meshopt, quantised or sparse data), saying what to
// do.
Result<GltfModel> ParseGltf(std::string_view bytes, const std::string& source,
                            const std::optional<std::filesystem::path>& folder);

// Where a vertex of a mesh goes, by the rules of the specification: a skinned mesh follows its
// joints alone, others the node. Linear in the vertex: the same matrix serves positions and
// displacements.
Eigen::Matrix4f SceneFromVertex(const GltfModel& model, int mesh_node,
                                const GltfModel::Primitive& primitive, std::size_t vertex);

// All vertices of a primitive with these weights of its targets: morphs first, then the skin.
std::vector<Eigen::Vector3f> EvaluatePrimitive(const GltfModel& model, int mesh_node,
                                               const GltfModel::Primitive& primitive,
                                               const std::vector<float>& target_weights);

}  // namespace articap
