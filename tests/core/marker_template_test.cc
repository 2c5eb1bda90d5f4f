// SPDX-License-Identifier: MIT
#include "core/marker_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace articap {
namespace {

using testing::HasSubstr;

MarkerTemplate TwoMarkers() {
  return {"anna",
          "frame 7 of \"take01\"",
          {{"brow", {1.25, 60, 80.5}, 0.75, true},
           {"chin", {-0.5, -90, 70}, 6, false, {0.5, -0.25, 4}}}};
}

std::string ErrorOf(const std::string& toml) {
  const auto parsed = ParseMarkerTemplate(toml, "t.toml");
  return parsed ? "" : parsed.error().message;
}

TEST(MarkerTemplateTest, ComesBackAsItWasWritten) {
  const std::string text = WriteMarkerTemplate(TwoMarkers());
  const auto read = ParseMarkerTemplate(text, "t.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, TwoMarkers());
  EXPECT_EQ(WriteMarkerTemplate(*read), text);
}

TEST(MarkerTemplateTest, ALayoutNeedsPlacesAlone) {
  const auto read =
      ParseMarkerTemplate("[[marker]]\nname = \"a\"\nposition_mm = [1.0, 2.0, 3.0]\n", "t.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->markers[0].sigma_mm, TemplateMarker{}.sigma_mm);
  EXPECT_FALSE(read->markers[0].head_reference);
}

TEST(MarkerTemplateTest, FaultsAreNamed) {
  const std::string marker = "[[marker]]\nname = \"a\"\nposition_mm = [1.0, 2.0, 3.0]\n";
  EXPECT_THAT(ErrorOf("name = \"x\"\n"), HasSubstr("[[marker]]"));
  EXPECT_THAT(ErrorOf(marker + marker), HasSubstr("twice"));
  EXPECT_THAT(ErrorOf(marker + "sigma_mm = 0\n"), HasSubstr("sigma_mm"));
  EXPECT_THAT(ErrorOf(marker + "colour = 3\n"), HasSubstr("colour"));
  EXPECT_THAT(ErrorOf(marker + "head = \"yes\"\n"), HasSubstr("head"));
  EXPECT_THAT(ErrorOf(marker + "unmeasured_mm = [1.0, inf, 3.0]\n"), HasSubstr("unmeasured_mm"));
  EXPECT_THAT(ErrorOf("[[marker]]\nname = \"a\"\nposition_mm = [nan, 2.0, 3.0]\n"),
              HasSubstr("position_mm"));
}

}  // namespace
}  // namespace articap
