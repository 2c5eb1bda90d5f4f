// SPDX-License-Identifier: MIT
#include "synthetic/sensor.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace articap {
namespace {

constexpr int kSide = 200;
constexpr int kPixels = kSide * kSide;

LinearPicture PlainPicture(float light, int width = kSide, int height = kSide) {
  return {width, height,
          std::vector<Eigen::Vector3f>(static_cast<std::size_t>(width) * height,
                                       Eigen::Vector3f::Constant(light))};
}

SensorOptions Bare() {
  SensorOptions options;
  options.format = PixelFormat::kGray16;
  options.blur_px = 0;
  options.black_level = 0.05;
  return options;
}

// In parts of the range.
std::vector<double> ValuesOf(const Image& image) {
  std::vector<double> values;
  for (std::size_t i = 0; i < image.bytes.size(); i += 2) {
    std::uint16_t value = 0;
    std::memcpy(&value, &image.bytes[i], 2);
    values.push_back(value / 65535.0);
  }
  return values;
}

// Mean and variance in electrons, over the black level.
struct Statistics {
  double mean_e = 0;
  double variance_e2 = 0;
};

Statistics StatisticsOf(const Image& image, const SensorOptions& options) {
  const double electrons = options.full_well_e / (1 - options.black_level);
  Statistics statistics;
  const std::vector<double> values = ValuesOf(image);
  const auto count = static_cast<double>(values.size());
  for (const double value : values)
    statistics.mean_e += (value - options.black_level) * electrons / count;
  for (const double value : values) {
    const double off_e = (value - options.black_level) * electrons - statistics.mean_e;
    statistics.variance_e2 += off_e * off_e / (count - 1);
  }
  return statistics;
}

// The photon transfer curve: variance = mean + read noise^2 (Janesick, Photon Transfer, 2007). A
// step of 16 bits is 0.16 electrons here and adds 0.002 to the variance. A sample variance of n
// normal numbers has the SD variance sqrt(2 / n); the kurtosis of a Poisson variable adds 1 / mean.
TEST(SensorTest, NoiseFollowsThePhotonTransferCurve) {
  const SensorOptions options = Bare();
  std::uint64_t seed = 1;
  for (const float light : {0.0f, 0.0005f, 0.003f, 0.05f, 0.4f, 0.9f}) {
    const double mean_e = light * options.full_well_e;
    const double variance_e2 = mean_e + options.read_noise_e * options.read_noise_e;
    const Statistics measured = StatisticsOf(Expose(PlainPicture(light), options, seed++), options);
    EXPECT_NEAR(measured.mean_e, mean_e, 4 * std::sqrt(variance_e2 / kPixels)) << light;
    const double fourth = 2 * variance_e2 * variance_e2 + mean_e;
    EXPECT_NEAR(measured.variance_e2, variance_e2, 4 * std::sqrt(fourth / kPixels)) << light;
  }
}

TEST(SensorTest, FullWellsSaturateAndNoiseAboveThemIsReadNoiseAlone) {
  SensorOptions options = Bare();
  options.exposure = 3;
  const std::vector<double> values = ValuesOf(Expose(PlainPicture(0.9f), options, 1));
  double darkest = 1;
  for (const double value : values) darkest = std::min(darkest, value);
  EXPECT_GT(darkest, 1 - 6 * options.read_noise_e / options.full_well_e);
}

TEST(SensorTest, TheSameSeedGivesTheSameBytes) {
  SensorOptions options;
  options.vignetting = 0.3;
  const LinearPicture light = PlainPicture(0.4f, 64, 48);
  const Image once = Expose(light, options, 7);
  EXPECT_EQ(Expose(light, options, 7).bytes, once.bytes);
  EXPECT_NE(Expose(light, options, 8).bytes, once.bytes);
}

TEST(SensorTest, ValuesFollowTheToneCurve) {
  SensorOptions options;
  options.noise = false;
  for (const PixelFormat format : {PixelFormat::kGray8, PixelFormat::kRgb8}) {
    options.format = format;
    options.tone = ToneCurve::kLinear;
    EXPECT_EQ(Expose(PlainPicture(0.215861f, 9, 9), options, 1).bytes[0], 55);
    options.tone = ToneCurve::kSrgb;
    EXPECT_EQ(Expose(PlainPicture(0.215861f, 9, 9), options, 1).bytes[0], 128);
    EXPECT_EQ(Expose(PlainPicture(0.0015174f, 9, 9), options, 1).bytes[0], 5);
  }
  EXPECT_EQ(Expose(PlainPicture(1, 9, 9), options, 1).bytes.size(), 3u * 81);
}

// Moments of the picture of a point: its light is kept, its centre stays, and variances add up;
// a disc of radius r has r^2 / 4 along each axis, to which its cut into pixels adds 1 / 12.
TEST(SensorTest, BlurSpreadsAPointAsFarAsAsked) {
  SensorOptions options = Bare();
  options.noise = false;
  options.black_level = 0;
  options.blur_px = 1.3;
  options.defocus_px = 3.2;
  LinearPicture point = PlainPicture(0, 61, 51);
  point.rgb[25 * 61 + 30] = Eigen::Vector3f::Ones();
  const std::vector<double> values = ValuesOf(Expose(point, options, 1));
  double light = 0, x1 = 0, x2 = 0, y2 = 0;
  for (int y = 0; y < 51; ++y)
    for (int x = 0; x < 61; ++x) {
      const double value = values[y * 61 + x], dx = x - 30, dy = y - 25;
      light += value;
      x1 += value * dx;
      x2 += value * dx * dx;
      y2 += value * dy * dy;
    }
  const double variance_px2 = 1.3 * 1.3 + 3.2 * 3.2 / 4 + 1.0 / 12;
  EXPECT_NEAR(light, 1, 0.005);
  EXPECT_NEAR(x1 / light, 0, 0.005);
  EXPECT_NEAR(x2 / light, variance_px2, 0.02 * variance_px2);
  EXPECT_NEAR(y2 / light, variance_px2, 0.02 * variance_px2);
}

TEST(SensorTest, PlainLightStaysPlainUpToTheBorder) {
  SensorOptions options = Bare();
  options.noise = false;
  options.blur_px = 1.3;
  options.defocus_px = 2.5;
  for (const double value : ValuesOf(Expose(PlainPicture(0.5f, 20, 12), options, 1)))
    ASSERT_NEAR(value, 0.05 + 0.95 * 0.5, 2e-5);
}

TEST(SensorTest, CornersLoseTheLightAsked) {
  SensorOptions options = Bare();
  options.noise = false;
  options.black_level = 0;
  options.vignetting = 0.4;
  const std::vector<double> values = ValuesOf(Expose(PlainPicture(0.5f, 41, 31), options, 1));
  EXPECT_NEAR(values[15 * 41 + 20], 0.5, 1e-4);
  EXPECT_NEAR(values[0], 0.3, 1e-4);
}

TEST(SensorTest, MotionBlurIsTheMeanOverTheExposure) {
  const LinearPicture mean =
      MotionBlur(4, [](double part) { return PlainPicture(static_cast<float>(part), 2, 2); });
  EXPECT_NEAR(mean.rgb[3].x(), 0.5, 1e-6);
}

}  // namespace
}  // namespace articap
