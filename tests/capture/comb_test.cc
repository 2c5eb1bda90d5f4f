// SPDX-License-Identifier: MIT
#include "capture/comb.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

namespace articap {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 80;

// What is seen at a place at a time counted in fields, 0 to 255.
using Scene = std::function<double(double x, double y, double field)>;

// Pictures of which every row was exposed at its field's time: both at once, or one after the
// other.
enum class Kind { kWhole, kTopFirst, kBottomFirst };

CombEvidence EvidenceOf(const Scene& scene, Kind kind, double noise = 0) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  CombMeter meter;
  for (int number = 0; number < 12; ++number) {
    Image image(PixelFormat::kGray8, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      const bool is_second = kind != Kind::kWhole && (y % 2 == 0) == (kind == Kind::kBottomFirst);
      for (int x = 0; x < kWidth; ++x) {
        const double level = scene(x, y, 2 * number + is_second) + noise * normal(random);
        image.row(y)[x] = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
      }
    }
    meter.Add(image.view());
  }
  return meter.evidence();
}

double Bar(double x, double, double field) {
  const double from = 10 + 3 * field;
  return x >= from && x < from + 15 ? 200 : 40;
}

// A slanted texture that moves slowly, as skin does.
double Texture(double x, double y, double field) {
  return 128 + 60 * std::sin(0.3 * (x - 0.8 * field) + 0.25 * y) +
         40 * std::sin(0.17 * (x - 0.8 * field) - 0.4 * y);
}

TEST(CombTest, WhatMovesShowsFieldsAndTheirOrder) {
  for (const Scene& scene : {Scene(Bar), Scene(Texture)})
    for (const double noise : {0.0, 4.0}) {
      EXPECT_EQ(EvidenceOf(scene, Kind::kWhole, noise).interlaced(), false);
      const CombEvidence top = EvidenceOf(scene, Kind::kTopFirst, noise);
      EXPECT_EQ(top.interlaced(), true) << top.comb;
      EXPECT_EQ(top.top_field_first(), true) << top.order;
      const CombEvidence bottom = EvidenceOf(scene, Kind::kBottomFirst, noise);
      EXPECT_EQ(bottom.interlaced(), true) << bottom.comb;
      EXPECT_EQ(bottom.top_field_first(), false) << bottom.order;
    }
}

TEST(CombTest, MeasuresAreThoseOfTheMovement) {
  // An edge's rows differ by half its movement, which is all that changes in the rows of a field.
  EXPECT_NEAR(EvidenceOf(Bar, Kind::kTopFirst).comb, 0.5, 0.1);
  EXPECT_NEAR(EvidenceOf(Bar, Kind::kTopFirst).order, 3, 0.3);
  EXPECT_NEAR(EvidenceOf(Bar, Kind::kBottomFirst).order, 1 / 3.0, 0.04);
  EXPECT_NEAR(EvidenceOf(Bar, Kind::kWhole).comb, 0, 0.01);
}

TEST(CombTest, WhatStandsStillSaysNothing) {
  const auto still = [](double x, double y, double) { return Texture(x, y, 0); };
  for (const double noise : {0.0, 4.0}) {
    const CombEvidence evidence = EvidenceOf(still, Kind::kTopFirst, noise);
    EXPECT_LT(evidence.moving_pixels, 1000);
    EXPECT_EQ(evidence.interlaced(), std::nullopt);
    EXPECT_EQ(evidence.top_field_first(), std::nullopt);
  }
}

// They look like fields, but for their order.
TEST(CombTest, StripesAsFineAsTheRowsAreNoFields) {
  const auto stripes = [](double x, double y, double field) {
    return Bar(x, y, field) > 100 ? 100 + 100 * std::fmod(y, 2) : 40.0;
  };
  EXPECT_NE(EvidenceOf(stripes, Kind::kWhole).interlaced(), true);
}

TEST(CombTest, SixteenBitsCountAsEight) {
  CombMeter meter;
  for (int number = 0; number < 3; ++number) {
    Image image(PixelFormat::kGray16, kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto level = static_cast<std::uint8_t>(Bar(x, y, 2 * number + y % 2));
        image.row(y)[2 * x] = image.row(y)[2 * x + 1] = level;
      }
    meter.Add(image.view());
  }
  EXPECT_NEAR(meter.evidence().comb, EvidenceOf(Bar, Kind::kTopFirst).comb, 0.05);
}

}  // namespace
}  // namespace articap
