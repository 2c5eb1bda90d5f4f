// SPDX-License-Identifier: MIT
#include "synthetic/text_grid_writer.h"

#include <gtest/gtest.h>

namespace articap {
namespace {

TEST(WriteTextGridTest, WritesPraatsLongForm) {
  TextGrid grid;
  grid.end_s = 1.5;
  grid.tiers.push_back({.name = "phones", .labels = {{0, 0.25, "SIL"}, {0.25, 1.5, "a \"b\""}}});
  EXPECT_EQ(WriteTextGrid(grid),
            "File type = \"ooTextFile\"\n"
            "Object class = \"TextGrid\"\n"
            "\n"
            "xmin = 0.000000\n"
            "xmax = 1.500000\n"
            "tiers? <exists>\n"
            "size = 1\n"
            "item []:\n"
            "    item [1]:\n"
            "        class = \"IntervalTier\"\n"
            "        name = \"phones\"\n"
            "        xmin = 0.000000\n"
            "        xmax = 1.500000\n"
            "        intervals: size = 2\n"
            "        intervals [1]:\n"
            "            xmin = 0.000000\n"
            "            xmax = 0.250000\n"
            "            text = \"SIL\"\n"
            "        intervals [2]:\n"
            "            xmin = 0.250000\n"
            "            xmax = 1.500000\n"
            "            text = \"a \"\"b\"\"\"\n");
}

TEST(WriteTextGridTest, ReadsBackAsItWas) {
  TextGrid grid;
  grid.end_s = 1.5;
  grid.tiers.push_back({.name = "words", .labels = {{0, 1.5, "ba-\"bi\""}}});
  grid.tiers.push_back({.name = "phones", .labels = {{0, 0.25, "SIL"}, {0.25, 1.5, "AA"}}});
  const auto read = ParseTextGrid(WriteTextGrid(grid), "test");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->tiers.size(), 2u);
  EXPECT_EQ(read->tiers[0].labels[0].text, "ba-\"bi\"");
  EXPECT_EQ(WriteTextGrid(*read), WriteTextGrid(grid));
}

}  // namespace
}  // namespace articap
