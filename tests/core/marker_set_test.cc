// SPDX-License-Identifier: MIT
#include "core/marker_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/landmarks.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::HasSubstr;

constexpr const char* kMap = R"(# a comment
name = "sample \"map\""

[head]
mode = "translation"
left = "+y"
up = "+z"
forward = [1.0, 0.0, 0.0]

[[marker]]
name = "Chin"
roles = ["strategic", "face"]
landmark = "chin"
offset_mm = 2

[[marker]]
name = "nose"
roles = ["head"]
landmark = "nose_tip"
region = "skull"

[[marker]]
name = "spare"
roles = []
)";

TEST(MarkerSetTest, ReadsEveryField) {
  const auto set = ParseMarkerSet(kMap, "map.toml");
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(set->name, "sample \"map\"");
  EXPECT_EQ(set->mode, StabilizationMode::kTranslation);
  ASSERT_TRUE(set->axes);
  EXPECT_EQ(set->axes->left_in_stage, Eigen::Vector3d::UnitY());
  EXPECT_EQ(set->axes->up_in_stage, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(set->axes->forward_in_stage, Eigen::Vector3d::UnitX());
  ASSERT_EQ(set->markers.size(), 3u);
  const MarkerRole* chin = set->FindAtLandmark("chin");
  ASSERT_NE(chin, nullptr);
  EXPECT_EQ(chin->name, "Chin");
  EXPECT_TRUE(chin->strategic && chin->face && !chin->head_reference);
  EXPECT_EQ(chin->offset_mm, 2);
  EXPECT_EQ(RegionOf(*chin), "jaw");
  EXPECT_EQ(RegionOf(*set->Find("nose")), "skull");
  EXPECT_EQ(RegionOf(*set->Find("spare")), "");
  EXPECT_EQ(set->Find("Nose"), nullptr);
}

TEST(MarkerSetTest, RoundTripsToTheByte) {
  const auto set = ParseMarkerSet(kMap, "map.toml");
  ASSERT_TRUE(set);
  const std::string text = WriteMarkerSet(*set);
  const auto again = ParseMarkerSet(text, "map.toml");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(WriteMarkerSet(*again), text);
  EXPECT_EQ(again->markers[0].offset_mm, 2);
}

struct BadMap {
  std::string text;
  std::string message;
};

class BadMarkerSetTest : public testing::TestWithParam<BadMap> {};

TEST_P(BadMarkerSetTest, IsRefusedWithItsLine) {
  const auto set = ParseMarkerSet(GetParam().text, "map.toml");
  ASSERT_FALSE(set);
  EXPECT_THAT(set.error().message, HasSubstr(GetParam().message));
}

const std::string kOne = "[[marker]]\nname = \"a\"\nroles = [\"face\"]\n";

INSTANTIATE_TEST_SUITE_P(
    , BadMarkerSetTest,
    testing::Values(
        BadMap{"", "has no markers"}, BadMap{"name = \n", "map.toml:1"},
        BadMap{"name = 5\n" + kOne, "map.toml:1: name must be"},
        BadMap{"titel = \"x\"\n" + kOne, "map.toml:1: unknown key 'titel'"},
        BadMap{kOne + "colour = 1\n", "map.toml:4: unknown key 'colour'"},
        BadMap{kOne + kOne, "map.toml:4: marker 'a' is there twice"},
        BadMap{"[[marker]]\nname = \"a\"\nroles = [\"eye\"]\n", "map.toml:3: unknown role 'eye'"},
        BadMap{"[[marker]]\nname = \"a\"\nroles = [\"face\", \"face\"]\n", "is there twice"},
        BadMap{"[[marker]]\nname = \"a\"\nroles = [7]\n", "map.toml:3: unknown role"},
        BadMap{"[[marker]]\nname = \"a\"\n", "has no roles"},
        BadMap{"[[marker]]\nroles = []\n", "has no name"},
        BadMap{"[marker]\nname = \"a\"\n", "write [[marker]]"},
        BadMap{"marker = [1]\n", "a marker is a table"},
        BadMap{kOne + "landmark = \"elbow\"\n", "map.toml:4: unknown landmark 'elbow'"},
        BadMap{kOne + "region = \"elbow\"\n", "map.toml:4: unknown region 'elbow'"},
        BadMap{kOne + "offset_mm = 200\n", "map.toml:4: offset_mm"},
        BadMap{kOne + "offset_mm = nan\n", "map.toml:4: offset_mm"},
        BadMap{"[head]\nmode = \"loose\"\n" + kOne, "map.toml:2: unknown mode 'loose'"},
        BadMap{"[head]\nleft = \"+x\"\n" + kOne, "all three or none"},
        BadMap{"[head]\nleft = \"x\"\nup = \"+y\"\nforward = \"+z\"\n" + kOne, "is no axis"},
        BadMap{"[head]\nleft = [1.0]\nup = \"+y\"\nforward = \"+z\"\n" + kOne, "an axis is"},
        BadMap{"[head]\nleft = \"+x\"\nup = \"+x\"\nforward = \"+z\"\n" + kOne, "right angles"},
        BadMap{"[head]\nleft = \"-x\"\nup = \"+y\"\nforward = \"+z\"\n" + kOne, "--mirror"},
        BadMap{"head = 3\n" + kOne, "head must be a table"}));

TEST(MarkerSetTest, ShippedMapsAreWhatTheyShouldBe) {
  const auto read = [](const std::string& name) {
    auto set = ReadMarkerSet(SourceFolder() / "maps" / (name + ".toml"));
    EXPECT_TRUE(set) << set.error().message;
    return set.value_or(MarkerSet{});
  };
  const auto count = [](const MarkerSet& set, bool MarkerRole::*role) {
    return std::ranges::count_if(set.markers, [&](const MarkerRole& m) { return m.*role; });
  };
  const MarkerSet spectacles = read("spectacles30");
  EXPECT_EQ(spectacles.name, "spectacles30");
  EXPECT_EQ(count(spectacles, &MarkerRole::head_reference), 5);
  EXPECT_EQ(count(spectacles, &MarkerRole::face), 30);
  EXPECT_EQ(count(spectacles, &MarkerRole::strategic), 8);
  const MarkerSet animface = read("animface");
  EXPECT_EQ(animface.markers.size(), 41u);
  EXPECT_EQ(count(animface, &MarkerRole::head_reference), 7);
  const MarkerSet haskins = read("haskins_ema");
  EXPECT_EQ(haskins.mode, StabilizationMode::kNone);
  EXPECT_EQ(count(haskins, &MarkerRole::face), 5);
  const MarkerSet mirror = read("mirror6");
  EXPECT_EQ(mirror.mode, StabilizationMode::kTranslation);
  EXPECT_EQ(mirror.markers.size(), 6u);
  EXPECT_EQ(count(mirror, &MarkerRole::head_reference), 1);
}

TEST(LandmarksTest, AreSymmetricAndKnowTheirRegions) {
  for (const LandmarkInfo& info : AllLandmarks()) {
    EXPECT_TRUE(IsRegion(info.region)) << info.name;
    EXPECT_EQ(FindLandmark(info.name), &info) << info.name << " is there twice";
    std::string opposite(info.name);
    const std::size_t at = opposite.find("left");
    if (at == std::string::npos) continue;
    const LandmarkInfo* right = FindLandmark(opposite.replace(at, 4, "right"));
    ASSERT_NE(right, nullptr) << info.name;
    EXPECT_THAT(
        right->typical_mm,
        PointNear(Eigen::Vector3d(-info.typical_mm.x(), info.typical_mm.y(), info.typical_mm.z()),
                  0.0));
    EXPECT_GT(info.typical_mm.x(), 0) << info.name;
  }
}

}  // namespace
}  // namespace articap
