// SPDX-License-Identifier: MIT
#include "render/draw.h"

#include <gmock/gmock.h>

#include <cmath>

namespace articap {
namespace {

const Eigen::Vector3f kRed(1, 0, 0);

Picture Black(int size) { return FilledPicture(size, size, Eigen::Vector3f::Zero()); }

// What was painted, in whole pixels.
double Painted(const Picture& picture) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.rgb8.size(); i += 3) sum += picture.rgb8[i] / 255.0;
  return sum;
}

TEST(DrawTest, RingHasItsRadiusAndWidth) {
  Picture picture = Black(60);
  DrawRing(picture, {30.3, 29.6}, 20, 2, kRed);
  EXPECT_NEAR(Painted(picture), 2 * M_PI * 20 * 2, 3);
  EXPECT_GT(picture.pixel(50, 30)[0], 200);
  EXPECT_EQ(picture.pixel(30, 30)[0], 0);
  EXPECT_EQ(picture.pixel(50, 30)[1], 0);
}

TEST(DrawTest, LineHasRoundEnds) {
  Picture picture = Black(60);
  DrawLine(picture, {10, 10}, {40, 50}, 3, kRed);
  EXPECT_NEAR(Painted(picture), 50 * 3 + M_PI * 1.5 * 1.5, 3);
  EXPECT_EQ(picture.pixel(25, 30)[0], 255);
}

TEST(DrawTest, CrossHasFourArms) {
  Picture picture = Black(40);
  DrawCross(picture, {20, 20}, 10, 2, kRed);
  for (const int x : {14, 26})
    for (const int y : {14, 26}) EXPECT_GT(picture.pixel(x, y)[0], 200);
  EXPECT_EQ(picture.pixel(20, 10)[0], 0);
}

TEST(DrawTest, WhatLiesOutsideOrNowhereIsLeftOut) {
  Picture picture = Black(20);
  DrawRing(picture, {-100, 400}, 5, 2, kRed);
  DrawLine(picture, {NAN, 1}, {3, 4}, 2, kRed);
  DrawLine(picture, {0, 0}, {1e300, 4}, 2, kRed);
  EXPECT_EQ(Painted(picture), 0);
  DrawRing(picture, {0, 0}, 10, 2, kRed);
  EXPECT_NEAR(Painted(picture), M_PI / 2 * 10 * 2, 4);
}

TEST(DrawTest, EdgedTextShowsOnItsOwnColour) {
  Picture picture = FilledPicture(40, 20, kRed);
  DrawEdgedText(picture, "L", 10, 5, 1, kRed);
  EXPECT_EQ(picture.pixel(10, 5)[0], 255);
  EXPECT_EQ(picture.pixel(9, 5)[0], 0);
}

TEST(DrawTest, EnlargedPixelsAreSquares) {
  Picture picture = Black(3);
  picture.pixel(1, 1)[0] = 255;
  const Picture enlarged = Enlarged(picture, 4);
  EXPECT_EQ(enlarged.width, 12);
  EXPECT_EQ(enlarged.height, 12);
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 12; ++x)
      EXPECT_EQ(enlarged.pixel(x, y)[0], x / 4 == 1 && y / 4 == 1 ? 255 : 0) << x << ", " << y;
}

TEST(DrawTest, PasteCutsOff) {
  Picture picture = Black(10);
  const Picture part = FilledPicture(6, 6, kRed);
  Paste(picture, part, 7, -2);
  Paste(picture, part, -30, 0);
  EXPECT_EQ(Painted(picture), 3 * 4);
}

}  // namespace
}  // namespace articap
