// SPDX-License-Identifier: MIT
#include "core/view_regions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/camera_fixtures.h"

namespace articap {
namespace {

using testing::HasSubstr;

// A camera of 1280x720 with two mirrors.
CameraArray TwoMirrors() {
  CameraArray array;
  array.cameras = {
      {.name = "front", .width = 1280, .height = 720, .lens = CentredLens(1800, 1280, 720)}};
  array.mirrors = {{.name = "left"}, {.name = "right"}};
  return array;
}

std::string RefusalOf(const std::vector<std::string>& texts) {
  CameraArray array = TwoMirrors();
  const auto set = SetViewRegions(texts, array);
  return set ? "" : set.error().message;
}

TEST(PictureRegionTest, PixelsAreWithinToTheirEdges) {
  const PictureRegion region = OrThrow(ParsePictureRegion("640x700+600+20"));
  EXPECT_EQ(region, (PictureRegion{600, 20, 640, 700}));
  EXPECT_EQ(FormatPictureRegion(region), "640x700+600+20");
  EXPECT_TRUE(region.Contains({599.5, 19.5}));
  EXPECT_FALSE(region.Contains({599.49, 100}));
  EXPECT_TRUE(region.Contains({1239.49, 719.49}));
  EXPECT_FALSE(region.Contains({1239.5, 100}));
}

TEST(ViewRegionsTest, ADotIsSeenByTheViewWhoseRegionItIsIn) {
  CameraArray array = TwoMirrors();
  const View direct{0, -1}, left{0, 0}, right{0, 1};
  ASSERT_TRUE(SetViewRegions({"front/left=400x720+880+0"}, array));
  EXPECT_TRUE(array.MayShow(left, {1000, 300}));
  EXPECT_FALSE(array.MayShow(direct, {1000, 300}));
  EXPECT_FALSE(array.MayShow(right, {1000, 300}));
  // Where no region is, whoever has none.
  EXPECT_FALSE(array.MayShow(left, {600, 300}));
  EXPECT_TRUE(array.MayShow(direct, {600, 300}));
  EXPECT_TRUE(array.MayShow(right, {600, 300}));
}

TEST(ViewRegionsTest, WhereRegionsOverlapADotMayBeEithers) {
  CameraArray array = TwoMirrors();
  ASSERT_TRUE(SetViewRegions({"front/left=400x720+880+0", "front=600x720+300+0"}, array));
  EXPECT_TRUE(array.MayShow({0, 0}, {890, 300}));
  EXPECT_TRUE(array.MayShow({0, -1}, {890, 300}));
  EXPECT_FALSE(array.MayShow({0, -1}, {950, 300}));
  EXPECT_FALSE(array.MayShow({0, -1}, {100, 300}));
}

TEST(ViewRegionsTest, WhatIsNoRegionIsRefusedWithWords) {
  EXPECT_THAT(RefusalOf({"front/side=400x720+880+0"}),
              HasSubstr("no view 'front/side'; there are front, front/left, front/right"));
  EXPECT_THAT(RefusalOf({"front/left"}), HasSubstr("write VIEW=WIDTHxHEIGHT+LEFT+TOP"));
  for (const char* text :
       {"400x720", "400x720+880", "0x720+880+0", "400x720-880+0", "400x720+1+2+"})
    EXPECT_THAT(RefusalOf({std::string("front/left=") + text}), HasSubstr("is no region")) << text;
  for (const char* text : {"400x720+881+0", "400x721+880+0", "2147483647x5+2147483647+0"})
    EXPECT_THAT(RefusalOf({std::string("front/left=") + text}),
                HasSubstr("of view 'front/left' does not lie within its picture of 1280x720"))
        << text;
  EXPECT_THAT(RefusalOf({"front=9x9+0+0", "front=9x9+9+9"}), HasSubstr("two regions"));
}

TEST(ViewRegionsTest, CalibrationsRememberThem) {
  CameraArray array = InventedCameras();
  const std::string without = WriteCalibration(array);
  array.cameras[0].region = PictureRegion{0, 0, 900, 1080};
  array.mirrors[0].region = PictureRegion{900, 100, 1020, 980};
  const std::string text = WriteCalibration(array);
  const CameraArray read = OrThrow(ParseCalibration(text, "calibration.toml"));
  EXPECT_EQ(read.cameras[0].region, array.cameras[0].region);
  EXPECT_EQ(read.cameras[1].region, std::nullopt);
  EXPECT_EQ(read.mirrors[0].region, array.mirrors[0].region);
  EXPECT_EQ(WriteCalibration(read), text);
  EXPECT_EQ(without.find("region"), std::string::npos);
  EXPECT_THAT(articap::RefusalOf(Replaced(text, "1020x980", "1021x980")),
              HasSubstr("file: region 1021x980+900+100 of view 'left/side' does not lie within"));
  EXPECT_THAT(articap::RefusalOf(Replaced(text, "1020x980+900", "1020x980")),
              HasSubstr("'region' '1020x980+100' is no region"));
}

}  // namespace
}  // namespace articap
