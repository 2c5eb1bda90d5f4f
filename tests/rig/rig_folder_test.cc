// SPDX-License-Identifier: MIT
#include "rig/io/rig_folder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/file_io.h"
#include "rig/default_head/default_head.h"
#include "tests/rig/toy_rig.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// The toy rig with all that a rig can have: two parts, morphs, awkward numbers and texts, an
// identity.
FaceRig MakeFullRig() {
  RigDefinition rig = MakeToyRig().definition();
  rig.name = "full \"rig\"\twith \\ and a line\nbreak";
  rig.part_names.push_back("teeth");
  for (std::size_t i = 0; i < rig.triangle_part.size(); i += 7) rig.triangle_part[i] = 1;
  rig.mesh.vertices[3] = {1.0 / 3, -1e-17, 6.02214076e23};
  rig.mesh.vertices[4] = {-0.0, std::numeric_limits<double>::denorm_min(), 0.1 + 0.2};
  rig.colors[5] = {1.0f / 3, 0.0f, 1.0f};
  rig.parameters.push_back(
      {"smile", ParameterUnit::kWeight, -0.25, 1, "Mundwinkel höher", "a guess"});
  const int smile = static_cast<int>(rig.parameters.size()) - 1;
  rig.morph_targets.push_back({smile, {{7, 2}, {{0.1, 1e-9, -3}, {4, 5, 1.0 / 7}}}});
  rig.morph_targets.push_back({smile, {{2}, {{0, 0, 1}}}});
  rig.identity_sliders.push_back({"width", -1, 2, "wider", {{1, 0}, {{0.5, 0, 0}, {-0.5, 0, 0}}}});
  FaceRig created = FaceRig::Create(std::move(rig)).value();
  Eigen::VectorXd identity = Eigen::VectorXd::Zero(created.identity().size());
  identity[identity.size() - 1] = 1.0 / 3;
  return created.WithIdentity(identity);
}

TEST(RigFolder, SavingWhatWasLoadedGivesTheSameBytes) {
  const auto folder = MakeTemporaryFolder("rig_folder_test");
  const FaceRig rig = MakeFullRig();
  const auto saved = SaveRig(rig, folder / "first");
  ASSERT_TRUE(saved) << saved.error().message;
  const auto loaded = LoadRig(folder / "first");
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_TRUE(SaveRig(*loaded, folder / "second"));
  for (const char* file : {"rig.toml", "mesh.obj", "weights.csv", "morphs.csv", "identity.csv"}) {
    const auto first = ReadFile(folder / "first" / file);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(*first, ReadFile(folder / "second" / file).value()) << file;
  }
}

TEST(RigFolder, EveryVertexOfEveryPoseSurvivesExactly) {
  const FaceRig rig = MakeFullRig();
  const auto loaded = ParseRig(SerializeRig(rig), "memory");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->definition().name, rig.definition().name);
  EXPECT_EQ(loaded->identity(), rig.identity());
  std::mt19937 random(5);
  for (int pose = 0; pose < 5; ++pose) {
    const Eigen::VectorXd parameters = Eigen::VectorXd::NullaryExpr(
        rig.num_parameters(), [&] { return std::ldexp(static_cast<double>(random()), -32); });
    EXPECT_EQ(loaded->Evaluate(parameters), rig.Evaluate(parameters));
  }
}

TEST(RigFolder, TheDefaultHeadSurvivesExactly) {
  const auto head = MakeDefaultHead();
  ASSERT_TRUE(head) << head.error().message;
  const auto loaded = ParseRig(SerializeRig(*head), "memory");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(SerializeRig(*loaded), SerializeRig(*head));
  EXPECT_EQ(HashOf(*loaded), HashOf(*head));
}

TEST(RigFolder, TheHashTellsRigsApart) {
  const FaceRig rig = MakeFullRig();
  EXPECT_EQ(HashOf(rig), HashOf(MakeFullRig()));
  EXPECT_NE(HashOf(rig), HashOf(MakeToyRig()));
  Eigen::VectorXd identity = rig.identity();
  identity[0] += 1e-12;
  EXPECT_NE(HashOf(rig), HashOf(rig.WithIdentity(identity)));
  RigDefinition moved = rig.definition();
  moved.mesh.vertices[0].x() += 1e-12;
  EXPECT_NE(HashOf(rig), HashOf(FaceRig::Create(std::move(moved)).value()));
}

TEST(RigFolder, ARigIsReplacedButNothingElseIs) {
  const auto folder = MakeTemporaryFolder("rig_folder_replace");
  ASSERT_TRUE(SaveRig(MakeFullRig(), folder / "rig"));
  ASSERT_TRUE(SaveRig(MakeToyRig(), folder / "rig"));
  EXPECT_FALSE(std::filesystem::exists(folder / "rig" / "morphs.csv"));
  EXPECT_EQ(HashOf(LoadRig(folder / "rig").value()), HashOf(MakeToyRig()));
  ASSERT_TRUE(WriteFile(folder / "rig" / "thesis.txt", "years of work"));
  const auto refused = SaveRig(MakeToyRig(), folder / "rig");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("other things than a rig"));
  EXPECT_TRUE(std::filesystem::exists(folder / "rig" / "thesis.txt"));
}

TEST(RigFolder, NamesThatTheFilesCannotHoldAreNamed) {
  RigDefinition rig = MakeToyRig().definition();
  rig.region_names[1] = "upper lip";
  const auto folder = MakeTemporaryFolder("rig_folder_names");
  const auto refused = SaveRig(FaceRig::Create(std::move(rig)).value(), folder / "rig");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("'upper lip'"));
  EXPECT_FALSE(std::filesystem::exists(folder / "rig"));
}

TEST(RigFolder, ARigThatCouldNotBeReadBackIsNotWritten) {
  RigDefinition rig = MakeToyRig().definition();
  rig.transforms[0].vector.x() = std::numeric_limits<double>::quiet_NaN();
  const auto folder = MakeTemporaryFolder("rig_folder_nan");
  EXPECT_FALSE(SaveRig(FaceRig::Create(std::move(rig)).value(), folder / "rig"));
  EXPECT_FALSE(std::filesystem::exists(folder / "rig"));
}

// One damage to one file, and what the message must say.
struct Damage {
  const char* file;
  std::string from;
  std::string to;
  const char* message;
};

class DamagedRigFolder : public testing::TestWithParam<Damage> {};

TEST_P(DamagedRigFolder, IsRefusedWithItsPlace) {
  RigFiles files = SerializeRig(MakeFullRig());
  std::string& text = files.at(GetParam().file);
  const auto at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos) << GetParam().from;
  text.replace(at, GetParam().from.size(), GetParam().to);
  const auto parsed = ParseRig(files, "rig");
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().message, AllOf(HasSubstr(std::string("rig/") + GetParam().file),
                                            HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    RigFolder, DamagedRigFolder,
    testing::Values(Damage{"rig.toml", "format = 1", "format = 7", "another version"},
                    Damage{"rig.toml", "format = 1", "format = = 1", "line 4"},
                    Damage{"rig.toml", "unit = \"rad\"", "unit = \"deg\"", "rad, mm, weight"},
                    Damage{"rig.toml", "max = ", "maximum = ", "no key that belongs here"},
                    Damage{"rig.toml", "weights = \"jaw\"", "weights = \"jow\"", "'jow'"},
                    Damage{"rig.toml", "min = -1.0", "min = nan", "finite"},
                    Damage{"rig.toml", "name = \"chin\"", "name = \"nose_tip\"",
                           "'nose_tip' twice"},
                    Damage{"mesh.obj", "\nf 1 ", "\nf 0 ", "vertex '0'"},
                    Damage{"mesh.obj", "\nf 1 ", "\nf 99999999 ", "vertex '99999999'"},
                    Damage{"mesh.obj", "\nf 1 ", "\nf 1 1 ", "4 corners"},
                    Damage{"mesh.obj", "g skin jaw", "g skin moon", "'skin moon'"},
                    Damage{"mesh.obj", "\nv ", "\nv inf ", "a vertex of 7 numbers"},
                    Damage{"mesh.obj", "\nv -42 ", "\nv nan ", "not a finite number"},
                    Damage{"weights.csv", "vertex,map", "vertex;map", "header"},
                    Damage{"weights.csv", "\n1,jaw,", "\n-1,jaw,", "no vertex '-1'"},
                    Damage{"weights.csv", ",jaw,", ",tail,", "no weight map 'tail'"},
                    Damage{"morphs.csv", "\n1,2,", "\n9,2,", "'9'"},
                    Damage{"identity.csv", "width,1,", "width,1,1,", "columns"}));

TEST(RigFolder, WeightsOutsideTheirRangeAreRefused) {
  RigFiles files = SerializeRig(MakeToyRig());
  files.at("weights.csv") = "vertex,map,weight\n3,jaw,1.5\n";
  const auto parsed = ParseRig(files, "rig");
  ASSERT_FALSE(parsed);
  EXPECT_THAT(parsed.error().message, HasSubstr("not between 0 and 1"));
}

TEST(RigFolder, CutOffFilesNeverCrash) {
  const RigFiles whole = SerializeRig(MakeFullRig());
  for (const auto& [name, bytes] : whole)
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 37) {
      RigFiles files = whole;
      files[name].resize(size);
      const auto parsed = ParseRig(files, "rig");
      if (!parsed) {
        EXPECT_THAT(parsed.error().message, HasSubstr("rig"));
      }
    }
}

TEST(RigFolder, AFolderWithoutARigSaysSo) {
  const auto loaded = LoadRig(MakeTemporaryFolder("rig_folder_empty"));
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("rig.toml is missing"));
}

}  // namespace
}  // namespace articap
