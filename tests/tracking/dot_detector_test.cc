// SPDX-License-Identifier: MIT
#include "tracking/dot_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "tests/support/face_dots.h"
#include "tests/tracking/dot_picture.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// One dot in the middle of 64 x 64 px.
LightPicture OneDot(const Eigen::Vector2d& center_px, double diameter_px) {
  LightPicture light(64, 64, 0.2);
  light.Add(PaintedDot::Disc(center_px, diameter_px));
  return light;
}

Image NoiseOf(PixelFormat format, int width, int height, std::uint64_t seed) {
  RandomGenerator random(seed, 1);
  Image image(format, width, height);
  for (std::uint8_t& byte : image.bytes) byte = static_cast<std::uint8_t>(random.Index(256));
  return image;
}

// The same pixels in rows that begin anywhere.
struct Strided {
  std::vector<std::uint8_t> bytes;
  ImageView view;
};
Strided WithOddRows(const ImageView& image, int offset, int gap) {
  const std::ptrdiff_t length =
      static_cast<std::ptrdiff_t>(image.width) * BytesPerPixel(image.format);
  Strided strided;
  strided.bytes.assign(offset + (length + gap) * image.height, 0xaa);
  for (int y = 0; y < image.height; ++y)
    std::memcpy(strided.bytes.data() + offset + y * (length + gap), image.row(y), length);
  strided.view = image;
  strided.view.data = strided.bytes.data() + offset;
  strided.view.stride_bytes = length + gap;
  return strided;
}

void ExpectSame(const std::vector<Dot>& first, const std::vector<Dot>& second) {
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].center_px, second[i].center_px);
    EXPECT_EQ(first[i].shape_px2, second[i].shape_px2);
    EXPECT_EQ(first[i].covariance_px2, second[i].covariance_px2);
    EXPECT_EQ(first[i].misfit, second[i].misfit);
  }
}

TEST(DotDetectorTest, SaysWhatADotIsLike) {
  RandomGenerator random(1, 1);
  PaintedDot dot{{31.3, 30.8}, {7, 5}, 0.4, 0.6, 0.7};
  LightPicture light(64, 64, 0.2);
  light.Add(dot);
  DotDetector detector({});
  const auto dots = detector.Detect(TakePicture(light, {}, random).view(), {});
  ASSERT_THAT(dots, SizeIs(1));
  EXPECT_NEAR(dots[0].contrast, 0.6, 0.01);
  EXPECT_NEAR(dots[0].background, 0.2, 0.005);
  EXPECT_NEAR(dots[0].roundness(), 5.0 / 7, 0.01);
  EXPECT_NEAR(dots[0].diameter_px(), 2 * std::sqrt(35.0), 0.05);
  // The longer axis along 0.4 rad.
  const Eigen::Vector2d axis(std::cos(0.4), std::sin(0.4));
  EXPECT_NEAR(axis.dot(dots[0].shape_px2 * axis), 49, 0.6);
  EXPECT_FALSE(dots[0].saturated);
  EXPECT_FALSE(dots[0].occluded);
  EXPECT_LT(dots[0].misfit, 2);
}

TEST(DotDetectorTest, DotsThatLeaveThePictureAreFlagged) {
  RandomGenerator random(2, 1);
  const Eigen::Vector2d center(2.4, 30.3);
  DotDetector detector({});
  const auto dots = detector.Detect(TakePicture(OneDot(center, 12), {}, random).view(), {});
  ASSERT_THAT(dots, SizeIs(1));
  EXPECT_TRUE(dots[0].occluded);
  EXPECT_LT((dots[0].center_px - center).norm(), 0.1);
}

TEST(DotDetectorTest, FieldsAndPixelsThatAreNotSquareGiveThePicturesCoordinates) {
  RandomGenerator random(3, 1);
  // A round dot of the picture, in every second row of which it is half as high.
  LightPicture light(64, 64, 0.2);
  PaintedDot dot = PaintedDot::Disc({31.3, 20.2}, 14);
  dot.semi_axes_px.y() /= 2;
  light.Add(dot);
  DotDetector detector({});
  PictureFromImage lower;
  lower.scale = {1, 2};
  lower.offset_px = {0, 1};
  const auto dots = detector.Detect(TakePicture(light, {}, random).view(), lower);
  ASSERT_THAT(dots, SizeIs(1));
  EXPECT_LT((dots[0].center_px - Eigen::Vector2d(31.3, 41.4)).norm(), 0.05);
  EXPECT_NEAR(dots[0].diameter_px(), 14, 0.1);
  EXPECT_GT(dots[0].roundness(), 0.97);
  EXPECT_GT(dots[0].covariance_px2(1, 1), dots[0].covariance_px2(0, 0));
}

TEST(DotDetectorTest, InstructionsAndRowsDoNotMatter) {
  for (const auto format : {PixelFormat::kGray8, PixelFormat::kGray16, PixelFormat::kRgb8}) {
    RandomGenerator random(4, 1);
    LightPicture light(301, 203, 0.2);
    for (int i = 0; i < 20; ++i)
      light.Add(PaintedDot::Disc({random.Uniform(0, 300), random.Uniform(0, 200)},
                                 random.Uniform(5, 30)));
    const PaintSensor sensor{.format = format == PixelFormat::kRgb8 ? PixelFormat::kGray8 : format};
    Image image = TakePicture(light, sensor, random);
    if (format == PixelFormat::kRgb8) {
      Image color(format, image.width, image.height);
      for (std::size_t i = 0; i < image.bytes.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) color.bytes[3 * i + channel] = image.bytes[i];
      image = color;
    }
    DotDetector detector({});
    const auto best = detector.Detect(image.view(), {});
    EXPECT_GT(best.size(), 8u);
    for (int level = 0; level <= static_cast<int>(BestSimdLevel()); ++level) {
      detector.set_simd_level(static_cast<SimdLevel>(level));
      ExpectSame(detector.Detect(image.view(), {}), best);
      for (const int gap : {1, 5, 31})
        ExpectSame(detector.Detect(WithOddRows(image.view(), gap, gap).view, {}), best);
    }
  }
}

TEST(DotDetectorTest, ColorTellsDotsFromOthers) {
  RandomGenerator random(5, 1);
  const Eigen::Vector3d skin(0.65, 0.45, 0.38), blue(0.15, 0.35, 0.8), white(0.9, 0.9, 0.9);
  Image image(PixelFormat::kRgb8, 160, 80);
  for (int channel = 0; channel < 3; ++channel) {
    LightPicture light(160, 80, skin[channel]);
    PaintedDot dot = PaintedDot::Disc({40.3, 40.6}, 12);
    dot.contrast = blue[channel] - skin[channel];
    light.Add(dot);
    dot.center_px = {110.3, 40.2};
    dot.contrast = white[channel] - skin[channel];
    light.Add(dot);
    const Image plane = TakePicture(light, {}, random);
    for (std::size_t i = 0; i < plane.bytes.size(); ++i)
      image.bytes[3 * i + channel] = plane.bytes[i];
  }
  DotDetectorOptions options;
  options.color = "#2659cc";
  const auto blues = DotDetector(options).Detect(image.view(), {});
  ASSERT_THAT(blues, SizeIs(1));
  EXPECT_LT((blues[0].center_px - Eigen::Vector2d(40.3, 40.6)).norm(), 0.05);
  const auto brights = DotDetector({}).Detect(image.view(), {});
  ASSERT_THAT(brights, SizeIs(1));
  EXPECT_LT((brights[0].center_px - Eigen::Vector2d(110.3, 40.2)).norm(), 0.05);
}

TEST(DotDetectorTest, RegionsKeepTheRestOut) {
  RandomGenerator random(6, 1);
  LightPicture light(160, 64, 0.2);
  light.Add(PaintedDot::Disc({40.3, 30}, 10));
  light.Add(PaintedDot::Disc({120.3, 30}, 10));
  const Image image = TakePicture(light, {}, random);
  DotDetectorOptions options;
  options.regions = {"100:0 159:0 159:63 100:63"};
  const auto dots = DotDetector(options).Detect(image.view(), {});
  ASSERT_THAT(dots, SizeIs(1));
  EXPECT_GT(dots[0].center_px.x(), 100);
  EXPECT_THAT(DotDetector({}).Detect(image.view(), {}), SizeIs(2));
}

// Ten times as bright on one side as on the other, and dots on both.
TEST(DotDetectorTest, BrightnessMayChangeOverThePictureAndOverTime) {
  RandomGenerator random(7, 1);
  DotDetectorOptions options;
  options.min_contrast = 0.012;
  DotDetector detector(options);
  for (const double exposure : {1.0, 0.3}) {
    LightPicture light(640, 100, 0);
    int painted = 0;
    for (int x = 40; x < 620; x += 60, ++painted) light.Add(PaintedDot::Disc({x + 0.3, 50.2}, 12));
    for (int y = 0; y < light.height; ++y)
      for (int x = 0; x < light.width; ++x)
        light.at(x, y) = exposure * (0.3 + light.at(x, y)) * (0.1 + 0.9 * x / 640.0);
    EXPECT_THAT(detector.Detect(TakePicture(light, {}, random).view(), {}), SizeIs(painted))
        << exposure;
  }
}

TEST(DotDetectorTest, PicturesWithoutDotsHaveNone) {
  DotDetector detector({});
  EXPECT_THAT(detector.Detect({}, {}), IsEmpty());
  for (const auto format : {PixelFormat::kGray8, PixelFormat::kGray16, PixelFormat::kRgb8})
    for (const auto& [width, height] : {std::pair(1, 1), {1, 300}, {300, 1}, {33, 7}, {300, 200}}) {
      for (const int value : {0, 128, 255}) {
        Image even(format, width, height);
        std::fill(even.bytes.begin(), even.bytes.end(), static_cast<std::uint8_t>(value));
        EXPECT_THAT(detector.Detect(even.view(), {}), IsEmpty()) << width << "x" << height;
      }
      detector.Detect(NoiseOf(format, width, height, 1).view(), {});
    }
  // Photons alone.
  RandomGenerator random(8, 1);
  for (const double light : {0.02, 0.3, 0.9})
    EXPECT_THAT(detector.Detect(TakePicture(LightPicture(640, 480, light), {}, random).view(), {}),
                IsEmpty())
        << light;
}

TEST(DotDetectorTest, LargeThingsAndTheirEdgesAreNone) {
  RandomGenerator random(9, 1);
  LightPicture light(400, 300, 0.1);
  light.Add(PaintedDot::Disc({150.2, 150.3}, 180));
  PaintedDot bar{{320, 150}, {4, 120}, 0.2, 0.6, 0.7};
  light.Add(bar);
  DotDetector detector({});
  EXPECT_THAT(detector.Detect(TakePicture(light, {}, random).view(), {}), IsEmpty());
}

TEST(DotDetectorTest, TooManyDotsAreSaid) {
  LightPicture light(800, 800, 0.2);
  for (int y = 10; y < 790; y += 20)
    for (int x = 10; x < 790; x += 20) light.Add(PaintedDot::Disc({x + 0.1, y + 0.2}, 8));
  RandomGenerator random(10, 1);
  const Image image = TakePicture(light, {}, random);
  DotDetectorOptions options;
  options.max_diameter_px = 12;
  options.most_dots = 300;
  DotDetector few(options);
  EXPECT_THAT(few.Detect(image.view(), {}), SizeIs(300));
  EXPECT_TRUE(few.report().too_many);
  options.most_dots = 2000;
  DotDetector all(options);
  EXPECT_THAT(all.Detect(image.view(), {}), SizeIs(39 * 39));
  EXPECT_FALSE(all.report().too_many);
}

TEST(DotDetectorTest, AFaceHasNoOtherDotsThanItsMarkers) {
  DotDetectorOptions options;
  options.min_diameter_px = 6;
  options.max_diameter_px = 22;
  options.min_contrast = 0.2;
  options.max_blur_px = 1;
  DotDetector detector(options);
  DotScore score;
  for (const FaceDotPicture& picture : RenderFaceDots({.pictures = 2, .seed = 2}))
    score.Add(picture, CentersOf(detector.Detect(picture.image.view(), {})));
  EXPECT_GT(score.clear, 20);
  EXPECT_EQ(score.found, score.clear);
  EXPECT_EQ(score.wrong, 0);
}

TEST(DotDetectorTest, OptionsThatCannotBeAreRefused) {
  const auto fault = [](auto change) {
    DotDetectorOptions options;
    change(options);
    const auto checked = CheckOptions(options);
    return checked ? std::string() : checked.error().message;
  };
  EXPECT_EQ(fault([](DotDetectorOptions&) {}), "");
  EXPECT_THAT(fault([](DotDetectorOptions& options) { options.min_diameter_px = 50; }),
              HasSubstr("the smaller one first"));
  EXPECT_THAT(fault([](DotDetectorOptions& options) { options.color = "blue"; }),
              HasSubstr("#rrggbb"));
  EXPECT_THAT(fault([](DotDetectorOptions& options) { options.regions = {"1:2 3:4"}; }),
              HasSubstr("three corners"));
  EXPECT_THAT(fault([](DotDetectorOptions& options) { options.regions = {"1:2 3;4 5:6"}; }),
              HasSubstr("\"3;4\" is no corner"));
  EXPECT_THAT(fault([](DotDetectorOptions& options) { options.min_roundness = 1.5; }),
              HasSubstr("a circle has 1"));
  EXPECT_THAT(fault([](DotDetectorOptions& options) { options.most_dots = 0; }),
              HasSubstr("most_dots"));
}

}  // namespace
}  // namespace articap
