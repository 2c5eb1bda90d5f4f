// SPDX-License-Identifier: MIT
#include "core/wav_writer.h"

#include <gmock/gmock.h>

#include <vector>

#include "core/file_io.h"
#include "core/wav_samples.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = WavHeader::SampleKind;

class WavWriterTest : public testing::Test {
 protected:
  ~WavWriterTest() override { fs::remove_all(folder_); }

  std::vector<float> Channel(int channel) const {
    std::vector<float> all;
    const WavHeader header = OrThrow(ReadWavHeader(path_));
    EXPECT_TRUE(ReadWavChannel(path_, header, channel, [&](std::span<const float> samples) {
      all.insert(all.end(), samples.begin(), samples.end());
    }));
    return all;
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_wav_writer_test");
  const fs::path path_ = folder_ / "a.wav";
};

struct Coding {
  WavFormat format;
  std::string frames;  // 0.5 and -1 in the first frame, 0.25 and 0 in the second
};

TEST_F(WavWriterTest, WhatIsWrittenIsRead) {
  using namespace std::string_literals;
  for (const std::int64_t largest_riff_bytes : {WavWriter::kLargestRiff_bytes, std::int64_t{10}})
    for (const auto& [format, frames] :
         {Coding{{Kind::kInteger, 16, 2, 44100}, "\x00\x40\x00\x80\x00\x20\x00\x00"s},
          Coding{{Kind::kInteger, 24, 2, 48000}, "\x00\x00\x40\x00\x00\x80\x00\x00\x20\0\0\0"s},
          Coding{{Kind::kInteger, 32, 2, 96000}, "\0\0\0\x40\0\0\0\x80\0\0\0\x20\0\0\0\0"s},
          Coding{{Kind::kFloat, 32, 2, 48000}, "\0\0\0\x3F\0\0\x80\xBF\0\0\x80\x3E\0\0\0\0"s},
          Coding{
              {Kind::kFloat, 64, 2, 48000},
              "\0\0\0\0\0\0\xE0\x3F\0\0\0\0\0\0\xF0\xBF\0\0\0\0\0\0\xD0\x3F\0\0\0\0\0\0\0\0"s}}) {
      fs::remove(path_);
      WavWriter writer = OrThrow(WavWriter::Create(path_, format, largest_riff_bytes));
      ASSERT_TRUE(writer.Write(frames));
      ASSERT_TRUE(writer.WriteSilence(1));
      EXPECT_FALSE(fs::exists(path_));
      ASSERT_TRUE(writer.Finish());
      const std::string bytes = OrThrow(ReadFile(path_));
      EXPECT_TRUE(bytes.starts_with(largest_riff_bytes > 10 ? "RIFF" : "RF64"));
      const WavHeader header = OrThrow(ReadWavHeader(path_));
      EXPECT_EQ(header.sample_kind, format.sample_kind);
      EXPECT_EQ(header.bits, format.bits);
      EXPECT_EQ(header.rate_hz, format.rate_hz);
      EXPECT_EQ(header.frames, 3);
      EXPECT_TRUE(header.warnings.empty());
      EXPECT_THAT(Channel(0), ElementsAre(0.5F, 0.25F, 0));
      EXPECT_THAT(Channel(1), ElementsAre(-1, 0, 0));
    }
}

TEST_F(WavWriterTest, WhatIsNotFinishedLeavesNothing) {
  {
    WavWriter writer = OrThrow(WavWriter::Create(path_, {}));
    ASSERT_TRUE(writer.WriteSilence(100'000));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_THAT(WavWriter::Create(folder_ / "none" / "a.wav", {}).error().message,
              HasSubstr("none/a.wav: cannot be written"));
}

}  // namespace
}  // namespace articap
