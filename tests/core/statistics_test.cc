// SPDX-License-Identifier: MIT
#include "core/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace articap {
namespace {

TEST(StatisticsTest, QuantilesAreValues) {
  const std::vector<double> values = {5, 1, 4, 2, 3, 6};
  EXPECT_EQ(QuantileOf(values, 0), 1);
  EXPECT_EQ(QuantileOf(values, 1), 6);
  EXPECT_EQ(QuantileOf(values, 0.19), 2);  // 0.95 of a rank above the least
  EXPECT_EQ(QuantileOf({7}, 0.3), 7);
  EXPECT_TRUE(std::isnan(QuantileOf({}, 0.5)));
}

TEST(StatisticsTest, TheMedianIsTheUpperMiddle) {
  EXPECT_EQ(MedianOf({3, 1, 2}), 2);
  EXPECT_EQ(MedianOf({4, 3, 1, 2}), 3);
  EXPECT_TRUE(std::isnan(MedianOf({})));
}

}  // namespace
}  // namespace articap
