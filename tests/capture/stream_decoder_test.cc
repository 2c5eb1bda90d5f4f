// SPDX-License-Identifier: MIT
#include "capture/stream_decoder.h"

#include <gtest/gtest.h>

#include "tests/capture/ffmpeg_files.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap::libav {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPlenty = 100'000'000;

class StreamDecoderTest : public testing::Test {
 protected:
  void SetUp() override {
    ARTICAP_NEEDS_FFMPEG();
    RunFfmpeg(folder_, WriteBars(folder_, film_) + "-pix_fmt yuv420p -c:v libx264 -bf 2 film.mp4");
  }
  ~StreamDecoderTest() override { fs::remove_all(folder_); }

  std::unique_ptr<StreamDecoder> Open() const {
    return OrThrow(StreamDecoder::Open({folder_ / "film.mp4"}, StreamKind::kVideo));
  }
  // The next pictures are those of the film from `first` to its end.
  void ExpectToTheEnd(StreamDecoder& decoder, int first) const {
    for (int i = first; i < film_.num_frames; ++i) {
      ASSERT_TRUE(OrThrow(decoder.Next())) << "picture " << i;
      EXPECT_NEAR(static_cast<double>(decoder.time()->count()), 1e9 * i / film_.rate_hz, 1);
    }
    EXPECT_FALSE(OrThrow(decoder.Next()));
  }

  const BarFilm film_{};
  const fs::path folder_ = MakeTemporaryFolder("articap_stream_decoder_test");
};

TEST_F(StreamDecoderTest, WhatWasDecodedComesAgain) {
  for (const int looked_at : {0, 7, film_.num_frames, film_.num_frames + 1}) {
    const auto decoder = Open();
    decoder->KeepForRestart(kPlenty);
    for (int i = 0; i < looked_at; ++i) EXPECT_EQ(OrThrow(decoder->Next()), i < film_.num_frames);
    ASSERT_TRUE(decoder->Restart());
    ExpectToTheEnd(*decoder, 0);
  }
}

TEST_F(StreamDecoderTest, WhatIsTooLargeIsNotKept) {
  const auto decoder = Open();
  decoder->KeepForRestart(5 * 160 * 64);  // three pictures and a little
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(OrThrow(decoder->Next()));
  EXPECT_FALSE(decoder->Restart());
  ExpectToTheEnd(*decoder, 7);
}

TEST_F(StreamDecoderTest, OnlyWhatIsToBeKeptComesAgain) {
  const auto decoder = Open();
  ASSERT_TRUE(OrThrow(decoder->Next()));
  EXPECT_FALSE(decoder->Restart());
  ExpectToTheEnd(*decoder, 1);
}

}  // namespace
}  // namespace articap::libav
