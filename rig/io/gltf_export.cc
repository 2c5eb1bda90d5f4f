// SPDX-License-Identifier: MIT
#include "rig/io/gltf_export.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <sstream>

#include "core/check.h"
#include "core/file_io.h"
#include "core/version.h"
#include "rig/io/gltf_compare.h"
#include "rig/io/gltf_model.h"
#include "rig/io/gltf_plan.h"
#include "rig/io/obj_mesh.h"
#include "rig/io/rig_toml.h"
#include "rig/io/tinygltf.h"

namespace articap {
namespace {

// Fills a tinygltf model with one buffer.
class GlbBuilder {
 public:
  GlbBuilder(const FaceRig& rig, const std::optional<RigAnimation>& animation)
      : rig_(rig), plan_(PlanTargets(rig)) {
    model_.asset.version = "2.0";
    model_.asset.generator = fmt::format("articap {}", kVersion);
    model_.buffers.emplace_back();
    AddMesh();
    AddNodes();
    if (animation && animation->parameters.rows() > 0) AddAnimation(*animation);
  }

  std::string Bytes() {
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    ARTICAP_CHECK(writer.WriteGltfSceneToStream(&model_, stream, false, true));
    return stream.str();
  }

  const TargetPlan& plan() const { return plan_; }

 private:
  static constexpr int kMeshNode = 0;
  static constexpr int kSkullNode = 1;
  static constexpr int kJawNode = 2;

  template <class Number>
  int AddAccessor(const std::vector<Number>& values, int type, int component_type, int target,
                  bool with_range = false) {
    std::vector<unsigned char>& bytes = model_.buffers[0].data;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = values.size() * sizeof(Number);
    view.target = target;
    bytes.resize(bytes.size() + view.byteLength);
    std::memcpy(bytes.data() + view.byteOffset, values.data(), view.byteLength);
    model_.bufferViews.push_back(view);

    const auto components =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)));
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = values.size() / components;
    if (with_range) {
      accessor.minValues.assign(values.begin(), values.begin() + static_cast<long>(components));
      accessor.maxValues = accessor.minValues;
      for (std::size_t i = 0; i < values.size(); ++i) {
        double& low = accessor.minValues[i % components];
        double& high = accessor.maxValues[i % components];
        low = std::min(low, static_cast<double>(values[i]));
        high = std::max(high, static_cast<double>(values[i]));
      }
    }
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  int AddFloats(const std::vector<float>& values, int type, bool with_range = false) {
    return AddAccessor(values, type, TINYGLTF_COMPONENT_TYPE_FLOAT, 0, with_range);
  }

  int AddVectors(const std::vector<Eigen::Vector3d>& vectors, bool with_range) {
    std::vector<float> values;
    for (const Eigen::Vector3d& vector : vectors)
      for (const double value : vector) values.push_back(static_cast<float>(value));
    return AddAccessor(values, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT,
                       TINYGLTF_TARGET_ARRAY_BUFFER, with_range);
  }

  // Displacements of a part, metres, at the target's full weight.
  std::vector<Eigen::Vector3d> PartDisplacements(const PartMesh& part, std::size_t target) const {
    const DisplacementField& field = rig_.field(plan_.parameters[target]);
    std::vector<Eigen::Vector3d> of_rig(rig_.neutral_mesh().vertices.size(),
                                        Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < field.vertices.size(); ++i)
      of_rig[field.vertices[i]] = plan_.scales[target] / kMetre_mm * field.displacements_mm[i];
    std::vector<Eigen::Vector3d> displacements;
    for (const int vertex : part.rig_vertex) displacements.push_back(of_rig[vertex]);
    return displacements;
  }

  int AddMaterial(const std::string& name) {
    tinygltf::Material material;
    material.name = name;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = name.starts_with("eyes")              ? 0.1
                                                    : name == "teeth" || name == "tongue" ? 0.3
                                                                                          : 0.6;
    material.doubleSided = true;
    model_.materials.push_back(material);
    return static_cast<int>(model_.materials.size()) - 1;
  }

  tinygltf::Primitive MakePrimitive(const PartMesh& part) {
    TriangleMesh mesh;
    std::vector<float> colors;
    for (const int vertex : part.rig_vertex) {
      mesh.vertices.emplace_back(rig_.neutral_mesh().vertices[vertex] / kMetre_mm);
      for (const float channel : rig_.definition().colors[vertex]) colors.push_back(channel);
    }
    mesh.triangles = part.triangles;
    std::vector<std::uint32_t> indices;
    for (const Eigen::Vector3i& triangle : part.triangles)
      for (const int corner : triangle) indices.push_back(static_cast<std::uint32_t>(corner));

    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = AddMaterial(part.name);
    primitive.indices =
        AddAccessor(indices, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                    TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    primitive.attributes["POSITION"] = AddVectors(mesh.vertices, true);
    primitive.attributes["NORMAL"] = AddVectors(UnitNormals(mesh), false);
    primitive.attributes["COLOR_0"] = AddAccessor(
        colors, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
    if (rig_.definition().jaw) AddSkinning(part, primitive);
    for (std::size_t target = 0; target < plan_.parameters.size(); ++target)
      primitive.targets.push_back(
          {{"POSITION", AddVectors(PartDisplacements(part, target), true)}});
    return primitive;
  }

  // glTF wants normals of unit length, at vertices without area too.
  static std::vector<Eigen::Vector3d> UnitNormals(const TriangleMesh& mesh) {
    std::vector<Eigen::Vector3d> normals = VertexNormals(mesh);
    for (Eigen::Vector3d& normal : normals)
      if (normal.isZero(0)) normal = Eigen::Vector3d::UnitZ();
    return normals;
  }

  void AddSkinning(const PartMesh& part, tinygltf::Primitive& primitive) {
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (const int vertex : part.rig_vertex) {
      const auto weight = static_cast<float>(rig_.jaw_weight(vertex));
      // Joints without weight are to be zero.
      joints.insert(joints.end(), {0, static_cast<std::uint8_t>(weight > 0 ? 1 : 0), 0, 0});
      weights.insert(weights.end(), {1 - weight, weight, 0, 0});
    }
    primitive.attributes["JOINTS_0"] =
        AddAccessor(joints, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE,
                    TINYGLTF_TARGET_ARRAY_BUFFER);
    primitive.attributes["WEIGHTS_0"] = AddAccessor(
        weights, TINYGLTF_TYPE_VEC4, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
  }

  void AddMesh() {
    tinygltf::Mesh mesh;
    mesh.name = rig_.definition().name;
    for (const PartMesh& part : PartMeshes(rig_.definition()))
      mesh.primitives.push_back(MakePrimitive(part));
    mesh.weights.assign(plan_.parameters.size(), 0.0);
    tinygltf::Value::Array names, parameters;
    for (std::size_t i = 0; i < plan_.parameters.size(); ++i) {
      const RigParameter& parameter = rig_.definition().parameters[plan_.parameters[i]];
      names.emplace_back(parameter.name);
      parameters.emplace_back(
          tinygltf::Value::Object{{"name", tinygltf::Value(parameter.name)},
                                  {"unit", tinygltf::Value(std::string(UnitName(parameter.unit)))},
                                  {"min", tinygltf::Value(parameter.min)},
                                  {"max", tinygltf::Value(parameter.max)},
                                  {"value_at_weight_1", tinygltf::Value(plan_.scales[i])}});
    }
    mesh.extras = tinygltf::Value(
        tinygltf::Value::Object{{"targetNames", tinygltf::Value(names)},
                                {"articapParameters", tinygltf::Value(parameters)}});
    model_.meshes.push_back(std::move(mesh));
  }

  void AddNodes() {
    tinygltf::Node face;
    face.name = rig_.definition().name;
    face.mesh = 0;
    tinygltf::Scene scene;
    scene.nodes = {kMeshNode};
    if (rig_.definition().jaw) {
      face.skin = 0;
      scene.nodes.push_back(kSkullNode);
    }
    model_.nodes.push_back(face);
    if (rig_.definition().jaw) AddJoints();
    model_.scenes.push_back(scene);
    model_.defaultScene = 0;
  }

  void AddJoints() {
    const Eigen::Vector3d pivot_m =
        PoseJaw(rig_, Eigen::VectorXd::Zero(rig_.num_parameters())).translation_m;
    tinygltf::Node skull;
    skull.name = "skull";
    skull.children = {kJawNode};
    tinygltf::Node jaw;
    jaw.name = "jaw";
    jaw.translation = {pivot_m.x(), pivot_m.y(), pivot_m.z()};
    model_.nodes.push_back(skull);
    model_.nodes.push_back(jaw);

    std::vector<float> inverse_bind;
    for (const Eigen::Vector3d& joint_m : {Eigen::Vector3d(0, 0, 0), pivot_m}) {
      Eigen::Matrix4f joint_from_mesh = Eigen::Matrix4f::Identity();
      joint_from_mesh.topRightCorner<3, 1>() = -joint_m.cast<float>();
      inverse_bind.insert(inverse_bind.end(), joint_from_mesh.data(), joint_from_mesh.data() + 16);
    }
    tinygltf::Skin skin;
    skin.joints = {kSkullNode, kJawNode};
    skin.skeleton = kSkullNode;
    skin.inverseBindMatrices = AddFloats(inverse_bind, TINYGLTF_TYPE_MAT4);
    model_.skins.push_back(skin);
  }

  void AddAnimation(const RigAnimation& animation) {
    std::vector<float> times_s, weights, translations, rotations;
    for (int frame = 0; frame < animation.parameters.rows(); ++frame) {
      const Eigen::VectorXd parameters = animation.parameters.row(frame).transpose();
      times_s.push_back(static_cast<float>(animation.start_s + frame / animation.rate_hz));
      const std::vector<float> frame_weights = TargetWeights(plan_, parameters);
      weights.insert(weights.end(), frame_weights.begin(), frame_weights.end());
      if (!rig_.definition().jaw) continue;
      const JawPose jaw = PoseJaw(rig_, parameters);
      for (const double value : jaw.translation_m)
        translations.push_back(static_cast<float>(value));
      for (const double value : jaw.rotation.coeffs())  // x y z w
        rotations.push_back(static_cast<float>(value));
    }
    tinygltf::Animation track;
    track.name = animation.name;
    const int input = AddFloats(times_s, TINYGLTF_TYPE_SCALAR, true);
    const auto add_channel = [&](int node, const char* path, int output) {
      tinygltf::AnimationSampler sampler;
      sampler.input = input;
      sampler.output = output;
      sampler.interpolation = "LINEAR";
      tinygltf::AnimationChannel channel;
      channel.sampler = static_cast<int>(track.samplers.size());
      channel.target_node = node;
      channel.target_path = path;
      track.samplers.push_back(sampler);
      track.channels.push_back(channel);
    };
    if (!weights.empty())
      add_channel(kMeshNode, "weights", AddFloats(weights, TINYGLTF_TYPE_SCALAR));
    if (rig_.definition().jaw) {
      add_channel(kJawNode, "translation", AddFloats(translations, TINYGLTF_TYPE_VEC3));
      add_channel(kJawNode, "rotation", AddFloats(rotations, TINYGLTF_TYPE_VEC4));
    }
    model_.animations.push_back(track);
  }

  const FaceRig& rig_;
  TargetPlan plan_;
  tinygltf::Model model_;
};

}  // namespace

Result<ExportReport> ExportGlb(const FaceRig& rig, const std::optional<RigAnimation>& animation,
                               const std::filesystem::path& path) {
  if (rig.definition().mesh.triangles.empty())
    return Fail(fmt::format("rig '{}' has no triangles to export", rig.definition().name));
  if (animation) {
    ARTICAP_CHECK_EQ(animation->parameters.cols(), rig.num_parameters());
    ARTICAP_CHECK_GT(animation->rate_hz, 0);
    if (!animation->parameters.allFinite())
      return Fail(
          "the animation holds parameters that are not finite; export a window of frames that "
          "were fitted");
  }
  GlbBuilder builder(rig, animation);
  const std::string bytes = builder.Bytes();
  auto model = ParseGltf(bytes, path.string(), std::nullopt);
  if (!model) return tl::unexpected(model.error());
  ExportReport report = CompareWithRig(rig, builder.plan(), std::move(*model), animation);
  report.bytes = bytes.size();
  if (!(report.largest_deviation_mm <= kMaxExportDeviation_mm))
    return Fail(
        fmt::format("{}: the file would deviate by {:.3g} mm from the rig, more than {} mm; it "
                    "was not written",
                    path.string(), report.largest_deviation_mm, kMaxExportDeviation_mm));
  if (auto written = WriteFile(path, bytes); !written) return tl::unexpected(written.error());
  return report;
}

Result<void> ExportObj(const FaceRig& rig, const Eigen::VectorXd& parameters,
                       const std::filesystem::path& path) {
  const RigDefinition& definition = rig.definition();
  std::vector<std::string> groups;
  for (const std::uint8_t part : definition.triangle_part)
    groups.push_back(definition.part_names[part]);
  return WriteFile(path, ObjText(rig.Evaluate(parameters), definition.mesh.triangles,
                                 definition.colors, groups));
}

}  // namespace articap
