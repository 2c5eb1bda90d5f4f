// SPDX-License-Identifier: MIT
#include "core/head_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace articap {
namespace {

using testing::HasSubstr;

TEST(HeadShapeCsvTest, RoundTripsToTheByte) {
  HeadShape shape;
  shape.points = {{"spectacles_1", {70.123456789, -1e-9, -70}},
                  {"with, comma and \"quotes\"", {0.1, 1.0 / 3, 1e7}},
                  {"Näse", {0, -0.0, 5}}};
  const std::string text = WriteHeadShapeCsv(shape);
  const auto read = ParseHeadShapeCsv(text, "shape.csv");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(WriteHeadShapeCsv(*read), text);
  ASSERT_NE(read->Find("with, comma and \"quotes\""), nullptr);
  EXPECT_EQ(read->Find("with, comma and \"quotes\"")->point_in_head_mm,
            shape.points[1].point_in_head_mm);
  EXPECT_EQ(read->Find("x_mm"), nullptr);
}

TEST(HeadShapeCsvTest, RefusesWithTheLine) {
  const std::string header = "name,x_mm,y_mm,z_mm\n";
  const std::pair<std::string, std::string> cases[] = {
      {"", "first line must be"},
      {"name,x,y,z\na,1,2,3\n", "first line must be"},
      {header, "has no points"},
      {header + "a,1,2\n", "shape.csv:2: 3 cells"},
      {header + "a,1,2,3\nb,1,x,3\n", "shape.csv:3: y_mm of 'b' is 'x'"},
      {header + "a,1,2,inf\n", "shape.csv:2: z_mm"},
      {header + ",1,2,3\n", "has no name"},
      {header + "a,1,2,3\na,1,2,3\n", "shape.csv:3: 'a' is there twice"},
      {header + "\"a,1,2,3\n", "shape.csv:2"},
  };
  for (const auto& [text, message] : cases) {
    const auto read = ParseHeadShapeCsv(text, "shape.csv");
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error().message, HasSubstr(message));
  }
}

}  // namespace
}  // namespace articap
