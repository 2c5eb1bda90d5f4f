// SPDX-License-Identifier: MIT
#include "report/packed.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "report/page_data.h"

namespace articap {
namespace {

using testing::ElementsAre;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What report/page/src/data.js does.
std::vector<double> Unpacked(const Json& packed) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : packed["data"].get<std::string>()) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> num_bits));
  }
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const auto code = static_cast<std::int16_t>(bytes[i] | bytes[i + 1] << 8);
    values.push_back(code == -32768
                         ? kNaN
                         : packed["offset"].get<double>() + packed["scale"].get<double>() * code);
  }
  return values;
}

TEST(PackedTest, Base64OfRfc4648) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xfe\xfd"), "//79");
}

TEST(PackedTest, QuantisedNumbersKeepTheirValueAndTheirGaps) {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(3 + 10 * std::sin(0.1 * i));
  values[17] = kNaN;
  values[18] = kInfinity;
  const std::vector<double> unpacked = Unpacked(Quantized(values));
  ASSERT_EQ(unpacked.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i]))
      EXPECT_NEAR(unpacked[i], values[i], 20.0 / 130'000) << i;
    else
      EXPECT_TRUE(std::isnan(unpacked[i])) << i;
}

TEST(PackedTest, QuantisesConstantsAndNothing) {
  EXPECT_THAT(Unpacked(Quantized(std::vector<double>{7, 7})), ElementsAre(7, 7));
  EXPECT_THAT(Unpacked(Quantized(std::vector<double>{})), ElementsAre());
  EXPECT_TRUE(std::isnan(Unpacked(Quantized(std::vector<double>{kNaN}))[0]));
  const double largest = 1e308;
  EXPECT_THAT(Unpacked(Quantized(std::vector<double>{-largest, largest})),
              ElementsAre(-largest, largest));
}

TEST(EnvelopeTest, KeepsTheLeastAndTheLargestOfEachBucket) {
  const Envelope envelope = EnvelopeOf(std::vector<double>{1, 5, kNaN, -2, 3, 4, kNaN, kNaN}, 3);
  EXPECT_THAT(envelope.low, ElementsAre(1, -2, testing::IsNan()));
  EXPECT_THAT(envelope.high, ElementsAre(5, 4, testing::IsNan()));
}

TEST(FramesPerPointTest, KeepsEveryFrameWhileThereIsRoom) {
  EXPECT_EQ(FramesPerPoint(70'000, 28), 1);
  const int per_point = FramesPerPoint(3'600'000, 28);
  EXPECT_LE(2.0 * 28 * 3'600'000 / per_point, 2.0e6);
}

}  // namespace
}  // namespace articap
