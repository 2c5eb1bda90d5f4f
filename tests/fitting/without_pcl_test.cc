// SPDX-License-Identifier: MIT
// Builds without PCL refuse what needs it, and say so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/icp_alignment.h"
#include "rig/default_head/default_head.h"

namespace articap {
namespace {

TEST(WithoutPclTest, CloudsAreNotAligned) {
  const FaceRig rig = MakeDefaultHead().value();
  const auto alignment = AlignCloudToRig(rig.neutral_mesh().vertices, rig);
  ASSERT_FALSE(alignment);
  EXPECT_THAT(alignment.error().message, testing::HasSubstr("has no PCL"));
}

}  // namespace
}  // namespace articap
