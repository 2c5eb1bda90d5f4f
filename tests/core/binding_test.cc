// SPDX-License-Identifier: MIT
#include "core/binding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/support/matchers.h"

namespace articap {
namespace {

using testing::HasSubstr;

Binding SmallBinding(const Sim3d& rig_from_head) {
  Binding binding;
  binding.rig_name = "a rig with \"quotes\"";
  binding.marker_set.name = "small";
  binding.marker_set.markers.push_back({.name = "chin"});
  binding.marker_set.markers.back().face = true;
  binding.head_shape.points = {{"spectacles_1", {0.1, 1.0 / 3, -7e-5}}};
  binding.reference_pose.points = {{"chin", {0, -105.25, 8.125}}};
  binding.reference_frames = {8, 67};
  binding.rig_from_head = rig_from_head;
  binding.rig_parameters = {{"jaw_rotation", 0.05}};
  binding.rig_identity = {{"face_width", -0.021}};
  binding.virtual_markers = {{"chin", {3, 14, 15}, 0.92, 0.06, 5.35}};
  binding.sources = {{"reference", "take 01.c3d", "00ff00ff00ff00ff"}};
  return binding;
}

TEST(BindingTest, WhatIsWrittenIsReadAgain) {
  const Sim3d similarity = Sim3d::FromParameters({1, 2, 3, 0.1, 0.2, 0.3, 0.94});
  const Binding written = SmallBinding(similarity);
  const auto read = ParseBinding(WriteBinding(written), "binding.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rig_name, written.rig_name);
  EXPECT_EQ(read->marker_set.markers.size(), 1u);
  EXPECT_EQ(read->reference_frames.first, 8);
  EXPECT_EQ(read->reference_frames.last, 67);
  EXPECT_THAT(read->rig_from_head, Sim3dNear(similarity, 1e-12, 1e-11, 1e-12));
  EXPECT_THAT(read->head_shape.points[0].point_in_head_mm,
              PointNear(written.head_shape.points[0].point_in_head_mm, 0));
  EXPECT_EQ(read->rig_parameters[0].value, 0.05);
  EXPECT_EQ(read->rig_identity[0].name, "face_width");
  const VirtualMarker& marker = read->virtual_markers[0];
  EXPECT_EQ(marker.triangle, written.virtual_markers[0].triangle);
  EXPECT_EQ(marker.u_mm, 5.35);
  EXPECT_EQ(read->sources[0].xxh3, "00ff00ff00ff00ff");
}

// write(read(write(x))) == write(x), however the head is turned, short of the angles' gimbal lock:
// a head and a rig, both with y up and z forward, are nowhere near it.
TEST(BindingTest, RoundTripsKeepEveryByte) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  std::uniform_real_distribution<double> length(-200, 200);
  for (int i = 0; i < 300; ++i) {
    const Sim3d similarity = Sim3d::FromParameters(
        {length(random), length(random), length(random), angle(random), 0.45 * angle(random),
         angle(random), std::exp(0.01 * length(random))});
    const std::string text = WriteBinding(SmallBinding(similarity));
    const auto read = ParseBinding(text, "binding.toml");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(WriteBinding(*read), text);
  }
}

TEST(BindingTest, FaultsAreNamed) {
  const std::string text = WriteBinding(SmallBinding({}));
  const auto fault_of = [&](const std::string& what, const std::string& instead) {
    std::string broken = text;
    broken.replace(broken.find(what), what.size(), instead);
    const auto read = ParseBinding(broken, "anna.toml");
    return read ? std::string() : read.error().message;
  };
  EXPECT_THAT(fault_of("xxh3", "md5"), HasSubstr("anna.toml, source 1: 'md5'"));
  EXPECT_THAT(fault_of("[3, 14, 15]", "[3, 14]"), HasSubstr("triangle"));
  EXPECT_THAT(fault_of("u_mm = 5.35", "u_mm = nan"), HasSubstr("u_mm"));
  EXPECT_THAT(fault_of("u_mm = 5.35", "u_mm = \"5\""), HasSubstr("u_mm"));
}

}  // namespace
}  // namespace articap
