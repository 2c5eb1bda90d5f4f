// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "core/file_io.h"
#include "rig/head_size.h"
#include "rig/io/import.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

// A box 160 mm wide, 220 high and 180 deep as OBJ text, in any unit, one vertex moved.
std::string BoxObj(double mm_per_unit, int moved_vertex = -1,
                   const Eigen::Vector3d& by_mm = Eigen::Vector3d::Zero()) {
  std::string text = "# a head, roughly\ng face\n";
  for (int i = 0; i < 8; ++i) {
    Eigen::Vector3d vertex_mm(i & 1 ? 80 : -80, i & 2 ? 110 : -110, i & 4 ? 90 : -90);
    if (i == moved_vertex) vertex_mm += by_mm;
    const Eigen::Vector3d vertex = vertex_mm / mm_per_unit;
    text += fmt::format("v {} {} {}\n", vertex.x(), vertex.y(), vertex.z());
  }
  return text +
         "f 5 6 8 7\nf 1/1/1 3//3 4/4 2\ng side\nf 2 4 8 6\nf 1 5 7 3\nf 3 7 8 4\nf 1 2 6 5\n";
}

std::filesystem::path WriteFolder(const std::string& name,
                                  const std::map<std::string, std::string>& files) {
  const auto folder = MakeTemporaryFolder(name);
  for (const auto& [file, bytes] : files) EXPECT_TRUE(WriteFile(folder / file, bytes));
  return folder;
}

std::string TextOf(const StageReport& report, const std::string& name) {
  for (const auto& [key, text] : report.texts)
    if (key == name) return text;
  return "(none)";
}

TEST(MorphImport, EveryObjFileIsATarget) {
  const auto folder = WriteFolder("obj_targets", {{"neutral.obj", BoxObj(1)},
                                                  {"open.obj", BoxObj(1, 4, {0, -20, -5})},
                                                  {"smile.obj", BoxObj(1, 7, {3, 4, 0})}});
  const auto imported = ImportRig(folder, std::nullopt, {});
  ASSERT_TRUE(imported) << imported.error().message;
  const FaceRig& rig = imported->output;
  EXPECT_EQ(rig.definition().name, folder.filename().string());
  ASSERT_EQ(rig.num_parameters(), 2);
  EXPECT_THAT(rig.definition().part_names, ElementsAre("face", "side"));
  const int open = rig.FindParameter("open").value();
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(2);
  parameters[open] = 0.5;
  // Vertex 4 is a corner of both parts, which have copies of it.
  int moved = 0;
  const auto posed = rig.Evaluate(parameters);
  for (int i = 0; i < rig.num_vertices(); ++i) {
    const Eigen::Vector3d step = posed[i] - rig.neutral_mesh().vertices[i];
    if (step.isZero(0)) continue;
    ++moved;
    EXPECT_THAT(rig.neutral_mesh().vertices[i], PointNear(Eigen::Vector3d(-80, -110, 90), 1e-12));
    EXPECT_THAT(step, PointNear(Eigen::Vector3d(0, -10, -2.5), 1e-12));
  }
  EXPECT_EQ(moved, 2);
  EXPECT_THAT(TextOf(imported->report, "missing_parameters"),
              AllOf(HasSubstr("jaw_rotation"), HasSubstr("lip_rounding"), HasSubstr("jaw_shift")));
  EXPECT_EQ(imported->report.warnings.size(), 1u);
}

constexpr const char* kRecipe = R"(
name = "boxy"
unit = "cm"
axes = ["-x", "z"]
origin_between = ["left_tragion", "right_tragion"]
landmarks = [
  {name = "left_tragion", vertex = 0},
  {name = "right_tragion", vertex = 1},
]
[[parts]]
name = "skin"
[[regions]]
name = "upper_lip"
outline_mm = [[0, 0], [200, 0], [200, 400], [0, 400]]
[[regions]]
name = "lower_lip"
[[parameters]]
name = "jaw_rotation"
min = -0.5
description = "opens"
targets = [{target = "open", gain = 2}, {target = "smile", gain = -1, side = "left", side_blend_mm = 1}]
)";

TEST(MorphImport, ARecipeGivesUnitAxesOriginRegionsAndParameters) {
  // Axes of the file: -x to the speaker's left, z up, so y points forward: left x up = (-x) x z =
  // y.
  const auto folder = WriteFolder("obj_recipe", {{"neutral.obj", BoxObj(10)},
                                                 {"open.obj", BoxObj(10, 4, {0, -20, -5})},
                                                 {"smile.obj", BoxObj(10, 6, {3, 4, 0})},
                                                 {"frown.obj", BoxObj(10, 7, {1, 1, 1})},
                                                 {"rig.toml", kRecipe}});
  const auto imported = ImportRig(folder, std::nullopt, {});
  ASSERT_TRUE(imported) << imported.error().message;
  const FaceRig& rig = imported->output;
  EXPECT_EQ(rig.definition().name, "boxy");
  // The origin lies between the file's (-80, -110, -90) and (80, -110, -90).
  EXPECT_THAT(rig.neutral_mesh().vertices[rig.FindLandmark("left_tragion").value()],
              PointNear(Eigen::Vector3d(80, 0, 0), 1e-9));
  ASSERT_EQ(rig.num_parameters(), 1);
  const DisplacementField& field = rig.field(0);
  ASSERT_EQ(field.vertices.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector3d& at = rig.neutral_mesh().vertices[field.vertices[k]];
    // (dx, dy, dz) of the file becomes (-dx, dz, dy); both moved vertices are at the left.
    const bool is_open = at.z() < 100;
    EXPECT_THAT(
        field.displacements_mm[k],
        PointNear(is_open ? Eigen::Vector3d(0, -10, -40) : Eigen::Vector3d(3, 0, -4), 1e-9));
  }
  EXPECT_THAT(rig.definition().region_names, ElementsAre("upper_lip", "lower_lip"));
  EXPECT_EQ(TextOf(imported->report, "unused_targets"), "frown");
}

TEST(MorphImport, HeadsOfAWrongSizeSayWhichUnitTheyLookLike) {
  for (const auto& [mm_per_unit, unit] :
       std::map<double, std::string>{{1000, "metres; pass --unit m"},
                                     {100, "decimetres; pass --unit dm"},
                                     {10, "centimetres; pass --unit cm"},
                                     {25.4, "--unit"}}) {
    const auto folder = WriteFolder("obj_unit", {{"neutral.obj", BoxObj(mm_per_unit)}});
    const auto refused = ImportRig(folder, std::nullopt, {});
    ASSERT_FALSE(refused) << mm_per_unit;
    EXPECT_THAT(refused.error().message, HasSubstr(unit));
  }
  const auto metres = WriteFolder("obj_metres", {{"neutral.obj", BoxObj(1000)}});
  EXPECT_TRUE(ImportRig(metres, std::nullopt, {.unit = "m"}));
  const auto refused = ImportRig(metres, std::nullopt, {.unit = "furlong"});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("furlong"));
  const auto giant = ImportRig(metres, std::nullopt, {.unit = "in"});
  EXPECT_FALSE(giant);
}

TEST(MorphImport, TargetsOfAnotherTopologyAreRefused) {
  std::string other = BoxObj(1);
  other.replace(other.find("f 5 6 8 7"), 9, "f 6 8 7 5");
  for (const std::string& target : {other, BoxObj(1) + "v 0 0 0\n", BoxObj(1) + "f 1 2 3\n"}) {
    const auto refused = ReadObjTargets({{"neutral.obj", BoxObj(1)}, {"open.obj", target}}, "box");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message,
                AllOf(HasSubstr("box/open.obj"), HasSubstr("do not match")));
  }
}

TEST(MorphImport, HostileObjFilesAreRefusedWithTheirLine) {
  const std::map<std::string, std::string> faults = {
      {"v 0 0 0\nf 1 1 2\n", "line 2"},
      {"v 0 0 0\nf 1 1 -2\n", "'-2'"},
      {"v 0 0\n", "line 1"},
      {"v 0 0 1e999\n", "1e999"},
      {"v 0 0 0\nf 1 1\n", "three corners"},
      {"v 0 0 0\nf 1 1 9999999999999\n", "line 2"},
      {"", "no vertices"},
      {"v 0 0 0 0 0 0\nv 0 0 0\n", "1 of 2 vertices"},
      {"v 0 0 0 0 0 7\n", "between 0 and 1"},
      {"v 1 2 0x10\n", "0x10"}};
  for (const auto& [text, message] : faults) {
    const auto refused = ReadObjTargets({{"neutral.obj", text}}, "hostile");
    ASSERT_FALSE(refused) << text;
    EXPECT_THAT(refused.error().message, HasSubstr(message));
  }
}

TEST(MorphImport, RecipesThatNameWhatIsNotThereAreRefused) {
  const auto source = ReadObjTargets({{"neutral.obj", BoxObj(1)}}, "box");
  ASSERT_TRUE(source);
  const auto build = [&](const std::string& text) -> std::string {
    const auto recipe = ParseImportRecipe(text, "recipe.toml");
    if (!recipe) return recipe.error().message;
    const auto rig = BuildMorphRig(*source, *recipe, {});
    return rig ? "fine" : rig.error().message;
  };
  EXPECT_EQ(build(""), "fine");
  EXPECT_THAT(build("[[parameters]]\nname = 'a'\ntargets = [{target = 'wink'}]"),
              HasSubstr("'wink'"));
  EXPECT_THAT(build("landmarks = [{name = 'chin', vertex = 8}]"), HasSubstr("'chin'"));
  EXPECT_THAT(build("landmarks = [{name = 'chin', vertex = -1}]"), HasSubstr("'chin'"));
  EXPECT_THAT(build("origin_between = ['a', 'b']"), HasSubstr("'a'"));
  EXPECT_THAT(build("axes = ['x', 'x']"), HasSubstr("axes"));
  EXPECT_THAT(build("[[parts]]\nname = 'skin'\ngroups = ['nobody']"), HasSubstr("face, side"));
  EXPECT_THAT(build("[[regions]]\nname = 'lip'\nfill_from = 100"), HasSubstr("vertex 100"));
  EXPECT_THAT(build("[jaw]\ntarget = 'open'\nangle_deg = 20\npivot_mm = [0, 0, 0]"),
              HasSubstr("'open'"));
  EXPECT_THAT(build("colour = 'red'"), HasSubstr("'colour' is no key"));
  EXPECT_THAT(build("unit = 'ell'"), HasSubstr("unit"));
  EXPECT_THAT(build("[[parameters]]\nname = 'a'\nmin = 2\ntargets = []"),
              testing::Not(HasSubstr("wink")));
}

TEST(MorphImport, PathsThatAreNoRigSayWhatIsExpected) {
  const auto folder = WriteFolder("no_rig", {{"readme.txt", "hello"}});
  EXPECT_THAT(ImportRig(folder, std::nullopt, {}).error().message, HasSubstr("neutral.obj"));
  EXPECT_THAT(ImportRig(folder / "readme.txt", std::nullopt, {}).error().message,
              HasSubstr(".glb or .gltf"));
  EXPECT_FALSE(ImportRig(folder / "nothing", std::nullopt, {}));
}

}  // namespace
}  // namespace articap
