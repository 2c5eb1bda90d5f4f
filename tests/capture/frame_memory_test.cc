// SPDX-License-Identifier: MIT
#include "capture/frame_memory.h"

#include <gtest/gtest.h>

#include <numeric>
#include <utility>

namespace articap {
namespace {

// Rows farther apart than they are wide, as decoders have them.
struct Padded {
  Image pixels{PixelFormat::kGray16, 8, 4};

  explicit Padded(std::uint8_t first) {
    std::iota(pixels.bytes.begin(), pixels.bytes.end(), first);
  }
  Frame frame(std::int64_t index) const {
    Frame frame;
    frame.index = index;
    frame.time = SessionTime(std::chrono::milliseconds(40 * index));
    frame.status = FrameStatus::kCorrupt;
    frame.image = pixels.view();
    frame.image.width = 5;
    frame.picture_from_image.scale = {1, 2};
    return frame;
  }
};

void ExpectSame(const Frame& stored, const Frame& frame) {
  EXPECT_EQ(stored.index, frame.index);
  EXPECT_EQ(stored.time, frame.time);
  EXPECT_EQ(stored.status, frame.status);
  EXPECT_EQ(stored.picture_from_image.scale, frame.picture_from_image.scale);
  ASSERT_EQ(stored.image.width, frame.image.width);
  ASSERT_EQ(stored.image.height, frame.image.height);
  ASSERT_EQ(stored.image.format, frame.image.format);
  const int row_bytes = frame.image.width * BytesPerPixel(frame.image.format);
  for (int y = 0; y < frame.image.height; ++y)
    EXPECT_TRUE(std::equal(frame.image.row(y), frame.image.row(y) + row_bytes, stored.image.row(y)))
        << "row " << y;
}

TEST(FrameMemoryTest, FramesOutliveTheirSource) {
  StoredVideo video;
  video.info.name = "front";
  const Padded second(100);
  {
    const Padded first(3);
    video.frames.emplace_back(first.frame(0));
    video.frames.emplace_back(first.frame(1));
  }
  video.frames[1].Store(second.frame(1));
  EXPECT_EQ(video.frames[1].num_bytes(), 5U * 4 * 2);
  const auto source = OpenStored(std::make_shared<const StoredVideo>(std::move(video)));
  EXPECT_EQ(source->info().name, "front");
  for (int round = 0; round < 2; ++round) {
    ExpectSame(**source->Next(), Padded(3).frame(0));
    ExpectSame(**source->Next(), second.frame(1));
    EXPECT_FALSE(source->Next()->has_value());
    ASSERT_TRUE(source->Rewind());
  }
}

}  // namespace
}  // namespace articap
