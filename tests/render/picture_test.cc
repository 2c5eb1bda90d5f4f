// SPDX-License-Identifier: MIT
#include "render/picture.h"

#include <gmock/gmock.h>
#include <png.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/file_io.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::HasSubstr;

Picture ColorfulPicture() {
  Picture picture = FilledPicture(37, 21, Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < picture.rgb8.size(); ++i)
    picture.rgb8[i] = static_cast<std::uint8_t>(i * 37 + i / 11);
  return picture;
}

TEST(Picture, PngHoldsEveryByte) {
  const Picture picture = ColorfulPicture();
  const auto path = MakeTemporaryFolder("picture_test") / "picture.png";
  ASSERT_TRUE(WritePng(picture, path));
  const auto read = ReadPng(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->width, 37);
  EXPECT_EQ(read->height, 21);
  EXPECT_EQ(read->rgb8, picture.rgb8);
}

TEST(Picture, GreyPngHoldsEveryByte) {
  Image grey(PixelFormat::kGray8, 23, 9);
  for (std::size_t i = 0; i < grey.bytes.size(); ++i)
    grey.bytes[i] = static_cast<std::uint8_t>(i * 41 + i / 7);
  const auto bytes = EncodePng(grey.view());
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto read = DecodePng(*bytes);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->rgb8.size(), 3 * grey.bytes.size());
  for (std::size_t i = 0; i < grey.bytes.size(); ++i)
    for (const std::size_t channel : {0, 1, 2})
      ASSERT_EQ(read->rgb8[3 * i + channel], grey.bytes[i]) << "byte " << i;
}

TEST(Picture, SixteenBitsStaySixteenBits) {
  Image deep(PixelFormat::kGray16, 5, 3);
  std::vector<std::uint16_t> values(15);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i * 4369);
  std::memcpy(deep.bytes.data(), values.data(), deep.bytes.size());
  const auto bytes = EncodePng(deep.view());
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ((*bytes)[24], 16);  // IHDR: bits a sample
  EXPECT_EQ((*bytes)[25], 0);   // IHDR: grey
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&png, bytes->data(), bytes->size()));
  png.format = PNG_FORMAT_LINEAR_Y;
  std::vector<std::uint16_t> read(values.size());
  ASSERT_TRUE(png_image_finish_read(&png, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, values);
}

TEST(Picture, DamagedPngIsRefused) {
  const auto bytes = EncodePng(ColorfulPicture());
  ASSERT_TRUE(bytes);
  const auto truncated = DecodePng(std::string_view(*bytes).substr(0, bytes->size() / 2));
  ASSERT_FALSE(truncated);
  EXPECT_THAT(truncated.error().message, HasSubstr("PNG"));
  EXPECT_FALSE(DecodePng("GIF89a"));
  EXPECT_FALSE(DecodePng(""));
}

TEST(Picture, WritingIntoAFileAsIfItWereAFolderNamesThePath) {
  const auto folder = MakeTemporaryFolder("picture_test_not_a_folder");
  ASSERT_TRUE(WriteFile(folder / "file", "x"));
  const auto written = WritePng(ColorfulPicture(), folder / "file" / "picture.png");
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("file"));
}

TEST(Picture, SrgbEncodingMatchesTheStandard) {
  EXPECT_EQ(SrgbByte(0.0f), 0);
  EXPECT_EQ(SrgbByte(1.0f), 255);
  EXPECT_EQ(SrgbByte(0.215861f), 128);  // ((128/255 + 0.055) / 1.055)^2.4
  EXPECT_EQ(SrgbByte(0.0015174f), 5);   // on the linear piece: 255 * 12.92 * x
  EXPECT_EQ(SrgbByte(-1.0f), 0);
  EXPECT_EQ(SrgbByte(7.0f), 255);
}

}  // namespace
}  // namespace articap
