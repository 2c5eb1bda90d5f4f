// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "core/file_io.h"
#include "rig/default_head/default_head.h"
#include "rig/io/gltf_compare.h"
#include "rig/io/gltf_export.h"
#include "rig/io/gltf_import.h"
#include "rig/io/import.h"
#include "rig/io/obj_mesh.h"
#include "tests/rig/toy_rig.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::Not;

RigAnimation Speech(const FaceRig& rig, int frames) {
  RigAnimation animation;
  animation.rate_hz = 50;
  animation.start_s = 2;
  animation.parameters.resize(frames, rig.num_parameters());
  for (int frame = 0; frame < frames; ++frame)
    for (int i = 0; i < rig.num_parameters(); ++i) {
      const RigParameter& range = rig.definition().parameters[i];
      const double share = 0.5 + 0.5 * std::sin(0.11 * frame * (i + 1) + i);
      animation.parameters(frame, i) = range.min + share * (range.max - range.min);
    }
  return animation;
}

std::string ExportedBytes(const FaceRig& rig, const std::optional<RigAnimation>& animation) {
  const auto path = MakeTemporaryFolder("gltf_test") / "rig.glb";
  const auto report = ExportGlb(rig, animation, path);
  EXPECT_TRUE(report) << report.error().message;
  return ReadFile(path).value();
}

// The same GLB with one text of its JSON replaced.
std::string WithJson(const std::string& glb, const std::string& from, const std::string& to) {
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, glb.data() + 12, 4);
  std::string json = glb.substr(20, json_size);
  const auto at = json.find(from);
  EXPECT_NE(at, std::string::npos) << from << " in " << json.substr(0, 2000);
  if (at != std::string::npos) json.replace(at, from.size(), to);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string edited = glb.substr(0, 12);
  const auto append = [&](std::uint32_t number) {
    edited.append(reinterpret_cast<const char*>(&number), 4);
  };
  append(static_cast<std::uint32_t>(json.size()));
  edited += glb.substr(16, 4) + json + glb.substr(20 + json_size);
  const auto size = static_cast<std::uint32_t>(edited.size());
  std::memcpy(edited.data() + 8, &size, 4);
  return edited;
}

TEST(GltfExport, DeviatesByFloatRoundingAlone) {
  for (const FaceRig& rig : {MakeToyRig(), MakeDefaultHead().value()}) {
    const auto path = MakeTemporaryFolder("gltf_deviation") / "rig.glb";
    const auto report = ExportGlb(rig, Speech(rig, 40), path);
    ASSERT_TRUE(report) << report.error().message;
    // Float32 at 0.2 m has steps of 1.5e-8 m; a few add up.
    EXPECT_LT(report->largest_deviation_mm, 1e-3);
    EXPECT_GT(report->largest_deviation_mm, 0);
    EXPECT_GE(report->poses_compared, 25 + 2 * rig.num_parameters() + 40);
    EXPECT_EQ(report->bytes, std::filesystem::file_size(path));
  }
}

TEST(GltfExport, TheComparisonSeesAFileThatDiffers) {
  const FaceRig rig = MakeToyRig();
  const RigAnimation animation = Speech(rig, 4);
  const GltfModel model = ParseGltf(ExportedBytes(rig, animation), "glb", std::nullopt).value();
  const TargetPlan plan = PlanTargets(rig);
  EXPECT_LT(CompareWithRig(rig, plan, model, animation).largest_deviation_mm, 1e-3);

  GltfModel other_pivot = model;
  other_pivot.skins[0].inverse_bind[1](1, 3) += 0.005f;
  EXPECT_NEAR(CompareWithRig(rig, plan, other_pivot, animation).largest_deviation_mm, 5, 2);
  GltfModel other_target = model;
  other_target.meshes[0].primitives[0].targets[0][20].x() += 0.002f;
  EXPECT_GT(CompareWithRig(rig, plan, other_target, animation).largest_deviation_mm, 0.1);
  GltfModel other_key = model;
  for (GltfModel::Channel& channel : other_key.channels)
    if (channel.path == "translation") channel.values[3] += 0.004f;  // x of the second frame
  EXPECT_NEAR(CompareWithRig(rig, plan, other_key, animation).largest_deviation_mm, 4, 1);
}

TEST(GltfExport, TheFileHoldsJawAndTargetsAsOtherProgramsReadThem) {
  const FaceRig rig = MakeDefaultHead().value();
  const auto model = ParseGltf(ExportedBytes(rig, std::nullopt), "rig.glb", std::nullopt);
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->nodes.size(), 3u);
  EXPECT_EQ(model->nodes[2].name, "jaw");
  ASSERT_EQ(model->skins.size(), 1u);
  const Eigen::Vector3d pivot_mm = rig.neutral_mesh().vertices[rig.definition().jaw->pivot_vertex];
  EXPECT_THAT(1000 * model->nodes[2].parent_from_node.translation().cast<double>(),
              PointNear(pivot_mm, 1e-4));
  std::vector<std::string> expected;
  for (const RigParameter& parameter : rig.definition().parameters)
    if (!parameter.name.starts_with("jaw_")) expected.push_back(parameter.name);
  EXPECT_THAT(model->meshes[0].target_names, ElementsAreArray(expected));
  EXPECT_TRUE(model->channels.empty());
}

TEST(GltfExport, AnimationsHaveTimesWeightsAndTheJaw) {
  const FaceRig rig = MakeToyRig();
  const RigAnimation animation = Speech(rig, 30);
  const auto model = ParseGltf(ExportedBytes(rig, animation), "rig.glb", std::nullopt);
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->channels.size(), 3u);
  const std::size_t num_targets = model->meshes[0].target_names.size();
  for (const GltfModel::Channel& channel : model->channels) {
    ASSERT_EQ(channel.times_s.size(), 30u);
    EXPECT_FLOAT_EQ(channel.times_s.front(), 2.0f);
    EXPECT_FLOAT_EQ(channel.times_s.back(), 2.0f + 29 / 50.0f);
    const std::size_t width = channel.path == "weights"       ? num_targets
                              : channel.path == "translation" ? 3
                                                              : 4;
    EXPECT_EQ(channel.values.size(), 30 * width) << channel.path;
  }
}

TEST(GltfExport, AnimationsWithHolesAreRefused) {
  const FaceRig rig = MakeToyRig();
  RigAnimation animation = Speech(rig, 3);
  animation.parameters(1, 0) = std::nan("");
  const auto path = MakeTemporaryFolder("gltf_holes") / "rig.glb";
  const auto refused = ExportGlb(rig, animation, path);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("not finite"));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(GltfExport, SameRigSameBytes) {
  const FaceRig rig = MakeToyRig();
  EXPECT_EQ(ExportedBytes(rig, Speech(rig, 5)), ExportedBytes(rig, Speech(rig, 5)));
}

TEST(GltfExport, ObjHoldsThePose) {
  const FaceRig rig = MakeToyRig();
  const Eigen::VectorXd pose = Speech(rig, 4).parameters.row(3).transpose();
  const auto path = MakeTemporaryFolder("obj_export") / "pose.obj";
  ASSERT_TRUE(ExportObj(rig, pose, path));
  const auto obj = ParseObj(ReadFile(path).value(), "pose.obj");
  ASSERT_TRUE(obj) << obj.error().message;
  EXPECT_EQ(obj->vertices, rig.Evaluate(pose));
  EXPECT_EQ(obj->faces.size(), rig.definition().mesh.triangles.size());
}

TEST(GltfImport, FindsTheTargetsThatWereExported) {
  const FaceRig rig = MakeDefaultHead().value();
  const auto path = MakeTemporaryFolder("gltf_round_trip") / "head.glb";
  ASSERT_TRUE(ExportGlb(rig, std::nullopt, path));
  const auto imported = ImportRig(path, std::nullopt, {});
  ASSERT_TRUE(imported) << imported.error().message;
  const FaceRig& again = imported->output;
  EXPECT_EQ(again.definition().mesh.triangles.size(), rig.definition().mesh.triangles.size());
  // A weight of 1 is the parameter's maximum. Vertices have another order: compare the triangles.
  for (const char* name : {"lip_rounding", "upper_lip_raise", "lower_lip_depression"}) {
    Eigen::VectorXd there = Eigen::VectorXd::Zero(rig.num_parameters());
    Eigen::VectorXd here = Eigen::VectorXd::Zero(again.num_parameters());
    const int parameter = rig.FindParameter(name).value();
    there[parameter] = rig.definition().parameters[parameter].max;
    here[again.FindParameter(name).value()] = 1;
    const auto expected = rig.Evaluate(there);
    const auto found = again.Evaluate(here);
    const auto sum_of = [](const FaceRig& of, const std::vector<Eigen::Vector3d>& vertices) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3i& triangle : of.definition().mesh.triangles)
        for (const int corner : triangle) sum += vertices[corner].cwiseProduct(vertices[corner]);
      return Eigen::Vector3d(sum /
                             (3.0 * static_cast<double>(of.definition().mesh.triangles.size())));
    };
    EXPECT_THAT(sum_of(again, found), PointNear(sum_of(rig, expected), 1e-2)) << name;
  }
}

TEST(GltfImport, NodesPlaceTheirMeshes) {
  const std::string glb = ExportedBytes(MakeToyRig(), std::nullopt);
  // The mesh loses its skin and hangs on a node that is turned a quarter about y, scaled and moved.
  const std::string placed =
      WithJson(glb, "\"skin\":0",
               "\"rotation\":[0,0.70710678118654757,0,0.70710678118654757],\"scale\":[2,2,2],"
               "\"translation\":[1,0,0]");
  const auto before = ParseGltf(glb, "glb", std::nullopt);
  const auto after = ParseGltf(placed, "glb", std::nullopt);
  ASSERT_TRUE(before && after) << after.error().message;
  const MorphSource from = MorphSourceOf(*before, "before");
  const MorphSource to = MorphSourceOf(*after, "after");
  ASSERT_EQ(from.vertices.size(), to.vertices.size());
  for (std::size_t i = 0; i < from.vertices.size(); ++i) {
    const Eigen::Vector3d& p = from.vertices[i];
    EXPECT_THAT(to.vertices[i],
                PointNear(Eigen::Vector3d(2 * p.z() + 1, 2 * p.y(), -2 * p.x()), 1e-6));
  }
  const Eigen::Vector3d& d = from.targets[0].field.displacements_mm[0];
  EXPECT_THAT(to.targets[0].field.displacements_mm[0],
              PointNear(Eigen::Vector3d(2 * d.z(), 2 * d.y(), -2 * d.x()), 1e-6));
}

TEST(GltfImport, FilesThatNeedADecoderSayWhatToDo) {
  const std::string glb = ExportedBytes(MakeToyRig(), std::nullopt);
  for (const char* extension :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization"}) {
    const std::string edited =
        WithJson(glb, "{\"accessors\"",
                 "{\"extensionsUsed\":[\"" + std::string(extension) + "\"],\"accessors\"");
    const auto refused = ParseGltf(edited, "face.glb", std::nullopt);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr(extension));
    EXPECT_THAT(refused.error().message, HasSubstr("export it again without compression"));
  }
}

TEST(GltfImport, HostileIndicesAndCountsAreRefused) {
  const std::string glb = ExportedBytes(MakeToyRig(), Speech(MakeToyRig(), 3));
  const std::pair<const char*, const char*> edits[] = {
      {"\"bufferView\":0", "\"bufferView\":9999"},
      {"\"byteOffset\":6720", "\"byteOffset\":4294967290"},
      {"\"count\":315", "\"count\":4000000000"},
      {"\"count\":315", "\"count\":316"},
      {"\"POSITION\":1", "\"POSITION\":77"},
      {"\"indices\":0", "\"indices\":1"},
      {"\"skin\":0", "\"skin\":5"},
      {"\"mesh\":0", "\"mesh\":5"},
      {"\"children\":[2]", "\"children\":[1]"},
      {"\"children\":[2]", "\"children\":[-7]"},
      {"\"joints\":[1,2]", "\"joints\":[1,9]"},
      {"\"joints\":[1,2]", "\"joints\":[1]"},
      {"\"sampler\":1", "\"sampler\":-1"},
      {"\"mode\":4", "\"mode\":1"},
      {"\"componentType\":5126", "\"componentType\":5122"},
  };
  for (const auto& [from, to] : edits) {
    const auto refused = ParseGltf(WithJson(glb, from, to), "face.glb", std::nullopt);
    EXPECT_FALSE(refused) << to;
    if (!refused) {
      EXPECT_THAT(refused.error().message, HasSubstr("face.glb")) << to;
    }
  }
}

TEST(GltfImport, CutOffFilesNeverCrash) {
  const std::string glb = ExportedBytes(MakeToyRig(), std::nullopt);
  for (std::size_t size = 0; size < glb.size(); size += 1 + size / 9)
    EXPECT_FALSE(ParseGltf(std::string_view(glb).substr(0, size), "face.glb", std::nullopt))
        << size;
  EXPECT_FALSE(ParseGltf("{}", "face.gltf", std::nullopt));
  EXPECT_FALSE(ParseGltf("not JSON", "face.gltf", std::nullopt));
}

TEST(GltfImport, AFileOnItsOwnReadsNoOthers) {
  const auto refused =
      ParseGltf(R"({"asset":{"version":"2.0"},"buffers":[{"uri":"/etc/hostname","byteLength":4}]})",
                "face.gltf", std::nullopt);
  ASSERT_FALSE(refused);
}

}  // namespace
}  // namespace articap
