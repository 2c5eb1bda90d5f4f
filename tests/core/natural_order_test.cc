// SPDX-License-Identifier: MIT
#include "core/natural_order.h"

#include <gtest/gtest.h>

namespace articap {
namespace {

TEST(NaturalOrderTest, NumbersCountByTheirValue) {
  EXPECT_TRUE(NaturallyBefore("take2", "take10"));
  EXPECT_FALSE(NaturallyBefore("take10", "take2"));
  EXPECT_TRUE(NaturallyBefore("take02", "take2")) << "leading zeros tell only equal ones apart";
  EXPECT_FALSE(NaturallyBefore("take2", "take2"));
}

TEST(NaturalOrderTest, TheLastNumberOfANameIsThatOfThePicture) {
  EXPECT_EQ(LastNumberIn("left03.jpg"), 3);
  EXPECT_EQ(LastNumberIn("cam1_0012_raw.png"), 12);
  EXPECT_EQ(LastNumberIn("0099"), 99);
  EXPECT_EQ(LastNumberIn("board.mp4"), std::nullopt) << "an ending is no part of it";
  EXPECT_EQ(LastNumberIn(""), std::nullopt);
  EXPECT_EQ(LastNumberIn("20240101120000123.png"), 20240101120000123);
  EXPECT_EQ(LastNumberIn("120240101120000123.png"), std::nullopt);
}

}  // namespace
}  // namespace articap
