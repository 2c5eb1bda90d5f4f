// SPDX-License-Identifier: MIT
#include "rig/pose_text.h"

#include <gmock/gmock.h>

#include <numbers>

namespace articap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

FaceRig SmallRig() {
  RigDefinition definition;
  definition.name = "small";
  definition.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  definition.mesh.triangles = {{0, 1, 2}};
  definition.colors.assign(3, Eigen::Vector3f::Ones());
  definition.part_names = {"skin"};
  definition.triangle_part = {0};
  definition.region_names = {"jaw"};
  definition.triangle_region = {0};
  const DisplacementField up = {{0}, {Eigen::Vector3d::UnitY()}};
  definition.weight_maps = {{"jaw", {1, 1, 1}}};
  definition.parameters = {{"jaw_rotation", ParameterUnit::kRadian, 0, 0.4, "", ""},
                           {"lip_rounding", ParameterUnit::kMillimetre, -2, 8, "", ""},
                           {"smile", ParameterUnit::kWeight, 0, 1, "", ""}};
  definition.morph_targets = {{1, up}, {2, up}};
  JawJoint jaw;
  jaw.rotation_parameter = 0;
  definition.jaw = jaw;
  definition.identity_sliders = {{"face_width", -1, 1, "", up}, {"nose", -1, 1, "", up}};
  auto rig = FaceRig::Create(definition);
  EXPECT_TRUE(rig) << rig.error().message;
  return *rig;
}

TEST(PoseText, ReadsUnits) {
  const auto pose =
      ParsePose(SmallRig(), {"jaw_rotation=10deg", "lip_rounding=-1.5mm", "smile=0.25"});
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_DOUBLE_EQ((*pose)[0], 10 * std::numbers::pi / 180);
  EXPECT_EQ((*pose)[1], -1.5);
  EXPECT_EQ((*pose)[2], 0.25);
}

TEST(PoseText, LeavesTheRestAtZero) {
  EXPECT_EQ(ParsePose(SmallRig(), {}).value(), Eigen::VectorXd::Zero(3));
  EXPECT_EQ(ParsePose(SmallRig(), {"smile=1"}).value(), Eigen::Vector3d(0, 0, 1));
}

TEST(PoseText, RefusesWhatItCannotUnderstand) {
  const FaceRig rig = SmallRig();
  const auto error_of = [&](const std::string& text) {
    const auto pose = ParsePose(rig, {text});
    return pose ? "accepted " + text : pose.error().message;
  };
  EXPECT_THAT(error_of("lip_rounding=3deg"), HasSubstr("does not fit the parameter"));
  EXPECT_THAT(error_of("jaw_rotatoin=10deg"),
              HasSubstr("it has jaw_rotation, lip_rounding, smile"));
  EXPECT_THAT(error_of("jaw_rotation=30deg"), HasSubstr("outside the range"));
  EXPECT_THAT(error_of("jaw_rotation=30deg"), HasSubstr(" deg"));
  EXPECT_THAT(error_of("jaw_rotation=0.1"), HasSubstr("without a unit"));
  EXPECT_FALSE(ParsePose(rig, {"smile=0.5", "smile=0.6"}));
  EXPECT_THAT(error_of("smile"), HasSubstr("not of the form name=value"));
  EXPECT_THAT(error_of("smile="), HasSubstr("not a number"));
  EXPECT_THAT(error_of("smile=nan"), HasSubstr("outside the range"));
}

TEST(PoseText, ReadsIdentity) {
  const auto sliders = ParseIdentity(SmallRig(), {"nose=-0.5"});
  ASSERT_TRUE(sliders) << sliders.error().message;
  EXPECT_THAT(*sliders, ElementsAre(std::nullopt, -0.5));
  EXPECT_FALSE(ParseIdentity(SmallRig(), {"nose=2"}));
  EXPECT_FALSE(ParseIdentity(SmallRig(), {"nose=1mm"}));
  EXPECT_FALSE(ParseIdentity(SmallRig(), {"chin=1"}));
}

}  // namespace
}  // namespace articap
