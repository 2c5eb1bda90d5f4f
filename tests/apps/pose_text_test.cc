// SPDX-License-Identifier: MIT
#include "apps/pose_text.h"

#include <gmock/gmock.h>

#include <numbers>

namespace articap {
namespace {

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
  const auto pose = ParsePose("jaw_rotation=10deg,lip_rounding=-1.5mm,smile=0.25", SmallRig());
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_DOUBLE_EQ((*pose)[0], 10 * std::numbers::pi / 180);
  EXPECT_EQ((*pose)[1], -1.5);
  EXPECT_EQ((*pose)[2], 0.25);
}

TEST(PoseText, LeavesTheRestAtZero) {
  EXPECT_EQ(ParsePose("", SmallRig()).value(), Eigen::VectorXd::Zero(3));
  EXPECT_EQ(ParsePose("smile=1", SmallRig()).value(), Eigen::Vector3d(0, 0, 1));
}

TEST(PoseText, RefusesWhatItCannotUnderstand) {
  const FaceRig rig = SmallRig();
  const auto error_of = [&](const std::string& text) {
    const auto pose = ParsePose(text, rig);
    return pose ? "accepted " + text : pose.error().message;
  };
  EXPECT_THAT(error_of("jaw_rotation=10"), HasSubstr("needs its unit, deg or rad"));
  EXPECT_THAT(error_of("lip_rounding=3deg"), HasSubstr("it is in mm"));
  EXPECT_THAT(error_of("jaw_rotatoin=10deg"),
              HasSubstr("it has jaw_rotation, lip_rounding, smile"));
  EXPECT_THAT(error_of("jaw_rotation=30deg"), HasSubstr("outside its range of 0 to 22.92 deg"));
  EXPECT_THAT(error_of("smile"), HasSubstr("not NAME=NUMBER"));
  EXPECT_THAT(error_of("smile="), HasSubstr("not NAME=NUMBER"));
  EXPECT_THAT(error_of("smile=nan"), HasSubstr("not NAME=NUMBER"));
}

TEST(PoseText, ReadsIdentity) {
  EXPECT_EQ(ParseIdentity("nose=-0.5", SmallRig()).value(), Eigen::Vector2d(0, -0.5));
  EXPECT_FALSE(ParseIdentity("nose=2", SmallRig()));
  EXPECT_FALSE(ParseIdentity("nose=1mm", SmallRig()));
  EXPECT_FALSE(ParseIdentity("chin=1", SmallRig()));
}

}  // namespace
}  // namespace articap
