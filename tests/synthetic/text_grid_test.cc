// SPDX-License-Identifier: MIT
#include "synthetic/text_grid.h"

#include <gtest/gtest.h>

namespace articap {
namespace {

TEST(WriteTextGridTest, WritesPraatsLongForm) {
  const TextGrid grid{0, 1.5, {{"phones", {{0, 0.25, "SIL"}, {0.25, 1.5, "a \"b\""}}}}};
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

}  // namespace
}  // namespace articap
