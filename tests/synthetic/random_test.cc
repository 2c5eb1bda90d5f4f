// SPDX-License-Identifier: MIT
#include "synthetic/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace articap {
namespace {

constexpr int kNumDraws = 100000;

TEST(RandomGeneratorTest, TheFirstNumbersNeverChange) {
  // Takes are named by their seed in papers and bug reports: these values are a promise.
  RandomGenerator random(1, 1);
  const double first = random.Uniform();
  const double second = random.Uniform();
  RandomGenerator again(1, 1);
  EXPECT_EQ(again.Uniform(), first);
  EXPECT_EQ(again.Uniform(), second);
  EXPECT_EQ(first, 0.71669132095293619);
  EXPECT_EQ(second, 0.74612850924531993);
}

TEST(RandomGeneratorTest, SeedsAndStreamsAreUnrelated) {
  RandomGenerator a(1, 1), b(2, 1), c(1, 2);
  double products_ab = 0, products_ac = 0;
  for (int i = 0; i < kNumDraws; ++i) {
    const double x = a.Normal();
    products_ab += x * b.Normal();
    products_ac += x * c.Normal();
  }
  // The mean product of independent normals has the SD 1 / sqrt(n); four of them.
  const double bound = 4 / std::sqrt(kNumDraws);
  EXPECT_LT(std::abs(products_ab / kNumDraws), bound);
  EXPECT_LT(std::abs(products_ac / kNumDraws), bound);
}

TEST(RandomGeneratorTest, NormalHasTheMomentsOfTheNormalDistribution) {
  RandomGenerator random(3, 1);
  std::array<double, 5> moments{};
  for (int i = 0; i < kNumDraws; ++i) {
    const double x = random.Normal();
    for (int power = 1; power <= 4; ++power) moments[power] += std::pow(x, power) / kNumDraws;
  }
  // Standard errors of the moments: sqrt(1, 2, 15, 96) / sqrt(n); four of them.
  const double error = 4 / std::sqrt(kNumDraws);
  EXPECT_NEAR(moments[1], 0, error);
  EXPECT_NEAR(moments[2], 1, std::sqrt(2.0) * error);
  EXPECT_NEAR(moments[3], 0, std::sqrt(15.0) * error);
  EXPECT_NEAR(moments[4], 3, std::sqrt(96.0) * error);
}

TEST(RandomGeneratorTest, IndexIsUniform) {
  RandomGenerator random(4, 1);
  std::array<int, 7> counts{};
  for (int i = 0; i < kNumDraws; ++i) ++counts[random.Index(7)];
  double chi_square = 0;
  const double expected = kNumDraws / 7.0;
  for (const int count : counts) chi_square += (count - expected) * (count - expected) / expected;
  EXPECT_LT(chi_square, 22.5);  // 99.9 % of the chi-square distribution with 6 degrees of freedom
}

// Against the probabilities themselves, on both sides of where the method changes.
TEST(RandomGeneratorTest, PoissonCountsComeAsOftenAsTheyShould) {
  constexpr int kMost = 100;
  for (const double mean : {0.3, 9.5, 10.5, 40.0}) {
    RandomGenerator random(5, 1);
    std::array<int, kMost> counts{};
    for (int i = 0; i < kNumDraws; ++i) ++counts[std::min(kMost - 1, random.Poisson(mean))];
    double chi_square = 0;
    int freedom = 0;
    for (int k = 0; k < kMost; ++k) {
      const double expected = kNumDraws * std::exp(k * std::log(mean) - mean - std::lgamma(k + 1));
      if (expected < 20) continue;
      chi_square += (counts[k] - expected) * (counts[k] - expected) / expected;
      ++freedom;
    }
    // Chi-square has the SD sqrt(2 n); its tail is longer than a normal one's, hence five.
    EXPECT_LT(chi_square, freedom + 5 * std::sqrt(2.0 * freedom)) << mean;
  }
  EXPECT_EQ(RandomGenerator(1, 1).Poisson(0), 0);
}

}  // namespace
}  // namespace articap
