// SPDX-License-Identifier: MIT
#include "capture/audio.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

#include "capture/media_kind.h"
#include "core/file_io.h"
#include "core/wav_samples.h"
#include "tests/capture/ffmpeg_files.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kRate_hz = 48000;
constexpr int kClick = 14'400;  // the sample in the middle of the click: 0.3 s
constexpr int kHalfClick = 240;

// A short tone that codecs for music keep, and that is like itself at one lag alone.
float ClickAt(int lag) {
  if (std::abs(lag) >= kHalfClick) return 0;
  const double window = 0.5 + 0.5 * std::cos(std::numbers::pi * lag / kHalfClick);
  return static_cast<float>(0.5 * window * std::cos(0.15 * lag + 0.0004 * lag * lag));
}

class AudioTest : public testing::Test {
 protected:
  void SetUp() override {
    ARTICAP_NEEDS_FFMPEG();
    film_.num_frames = 40;
    film_.step_px = 2;
    std::string bytes;
    for (int i = 0; i < kRate_hz * 4 / 5; ++i) {
      const auto sample = static_cast<std::int16_t>(std::lround(32767 * ClickAt(i - kClick)));
      bytes.append(reinterpret_cast<const char*>(&sample), 2);
    }
    ASSERT_TRUE(WriteFile(folder_ / "click.s16", bytes));
    inputs_ = WriteBars(folder_, film_);
  }
  ~AudioTest() override { fs::remove_all(folder_); }

  // A video with the click at 0.3 s, plus `late_s`, of its pictures.
  ExtractedAudio Make(const std::string& name, const std::string& coding, double late_s = 0) {
    RunFfmpeg(
        folder_,
        inputs_ + fmt::format("-itsoffset {} -f s16le -ar {} -ac 1 -i click.s16 -map 0 -map 1 "
                              "-pix_fmt yuv420p {} {}",
                              late_s, kRate_hz, coding, name));
    return OrThrow(ExtractAudio({folder_ / name}, wav_));
  }

  std::vector<float> Samples() const {
    std::vector<float> all;
    EXPECT_TRUE(
        ReadWavChannel(wav_, OrThrow(ReadWavHeader(wav_)), 0, [&](std::span<const float> samples) {
          all.insert(all.end(), samples.begin(), samples.end());
        }));
    return all;
  }

  // Where the click is, in samples from the first picture.
  double FindClick(const ExtractedAudio& audio) const {
    const std::vector<float> samples = Samples();
    int best = 0;
    double best_sum = 0;
    for (int middle = kHalfClick; middle + kHalfClick < static_cast<int>(samples.size());
         ++middle) {
      if (std::abs(samples[static_cast<std::size_t>(middle)]) < 0.1F) continue;
      double sum = 0;
      for (int lag = -kHalfClick; lag < kHalfClick; ++lag)
        sum += ClickAt(lag) * samples[static_cast<std::size_t>(middle + lag)];
      if (sum > best_sum) std::tie(best, best_sum) = std::pair(middle, sum);
    }
    return best + static_cast<double>(audio.offset.count()) * 1e-9 * kRate_hz;
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_audio_test");
  const fs::path wav_ = folder_ / "out.wav";
  BarFilm film_;
  std::string inputs_;
};

struct Coding {
  const char* name;
  const char* arguments;
  double tolerance_samples;
  int bits;
};

// One sample is 0.02 ms. Matroska's millisecond is 48 of them, less what the mean over the packets
// makes good; MP4 counts where a stream begins in a unit of the file's choice.
const Coding kCodings[] = {
    {"pcm.mov", "-c:v libx264 -c:a pcm_s16le -movie_timescale 48000", 1, 16},
    {"pcm24.mov", "-c:v libx264 -c:a pcm_s24le -movie_timescale 48000", 1, 24},
    {"aac.mp4", "-c:v libx264 -c:a aac -b:a 128k -movie_timescale 48000", 1, 32},
    {"mp3.mp4", "-c:v libx264 -c:a libmp3lame -b:a 192k -movie_timescale 48000", 1, 32},
    {"opus.mp4", "-c:v libx264 -c:a libopus -b:a 128k -movie_timescale 48000", 1, 32},
    {"aac.mts", "-c:v libx264 -c:a aac -b:a 128k", 1, 32},
    {"ac3.mts", "-c:v libx264 -c:a ac3 -b:a 192k", 1, 32},
    {"mp2.ts", "-c:v mpeg2video -q:v 3 -c:a mp2 -b:a 192k", 1, 16},
    {"pcm.mkv", "-c:v ffv1 -c:a pcm_s16le", 24, 16},
    {"flac.mkv", "-c:v ffv1 -c:a flac", 24, 16},
    {"aac.mkv", "-c:v libx264 -c:a aac -b:a 128k", 24, 32},
};

TEST_F(AudioTest, AClickStaysWhereThePicturesSawIt) {
  for (const Coding& coding : kCodings)
    for (const double late_s : {0.0, 0.1234}) {
      SCOPED_TRACE(fmt::format("{}, {} s late", coding.name, late_s));
      const ExtractedAudio audio = Make(coding.name, coding.arguments, late_s);
      EXPECT_NEAR(FindClick(audio), kClick + late_s * kRate_hz, coding.tolerance_samples);
      EXPECT_THAT(audio.notes, IsEmpty());
      EXPECT_EQ(audio.format.bits, coding.bits);
      EXPECT_EQ(audio.format.rate_hz, kRate_hz);
      EXPECT_EQ(audio.frames, static_cast<std::int64_t>(Samples().size()));
    }
}

TEST_F(AudioTest, PcmComesToTheBit) {
  Make("pcm.mov", "-c:v libx264 -c:a pcm_s16le");
  const std::string bytes = OrThrow(ReadFile(wav_));
  EXPECT_NE(bytes.find(OrThrow(ReadFile(folder_ / "click.s16"))), std::string::npos);
}

TEST_F(AudioTest, SoundBeforeThePicturesHasANegativeOffset) {
  const ExtractedAudio audio = Make("early.mts", "-c:v libx264 -c:a ac3 -b:a 192k", -0.2);
  EXPECT_LT(audio.offset.count(), -150'000'000);
  EXPECT_NEAR(FindClick(audio), kClick - 0.2 * kRate_hz, 1);
}

TEST_F(AudioTest, LostPiecesBecomeSilence) {
  Make("whole.ts", "-c:v mpeg2video -q:v 3 -c:a mp2 -b:a 192k", 0);
  // The packets of sound between 0.1 and 0.2 s are lost.
  RunFfmpeg(folder_,
            "-copyts -i whole.ts -map 0 -c copy -bsf:a "
            "\"noise=drop='between(pts*tb,1.5,1.6)'\" lost.ts");
  const ExtractedAudio audio = OrThrow(ExtractAudio({folder_ / "lost.ts"}, wav_));
  ASSERT_THAT(audio.notes, ElementsAre(HasSubstr("silence stands for them")));
  EXPECT_NEAR(FindClick(audio), kClick, 1);
}

TEST_F(AudioTest, PartsAreJoined) {
  for (const int reset : {0, 1}) {
    SCOPED_TRACE(reset);
    RunFfmpeg(folder_,
              inputs_ + fmt::format("-f s16le -ar {} -ac 1 -i click.s16 -map 0 -map 1 -pix_fmt "
                                    "yuv420p -c:v libx264 -g 10 -c:a pcm_s16le -f segment "
                                    "-segment_time 0.2 -reset_timestamps {} part%d.mkv",
                                    kRate_hz, reset));
    const ExtractedAudio audio = OrThrow(
        ExtractAudio({folder_ / "part0.mkv", folder_ / "part1.mkv", folder_ / "part2.mkv"}, wav_));
    EXPECT_NEAR(FindClick(audio), kClick, 24);
    EXPECT_EQ(audio.notes.size(), reset == 1 ? 2 : 0);
  }
}

TEST_F(AudioTest, FilesOfSoundAloneBeginAtZero) {
  for (const char* coding : {"-c:a libmp3lame -b:a 192k a.mp3", "-c:a aac -b:a 128k a.m4a",
                             "-c:a flac a.flac", "-c:a libopus -b:a 128k a.ogg"}) {
    SCOPED_TRACE(coding);
    RunFfmpeg(folder_, fmt::format("-f s16le -ar {} -ac 1 -i click.s16 {}", kRate_hz, coding));
    const std::string name = std::string(coding).substr(std::string(coding).rfind(' ') + 1);
    EXPECT_EQ(MediaKindOf(folder_ / name), MediaKind::kAudio);
    const ExtractedAudio audio = OrThrow(ExtractAudio({folder_ / name}, wav_));
    EXPECT_EQ(audio.offset.count(), 0);
    EXPECT_NEAR(FindClick(audio), kClick, 1);
  }
}

TEST_F(AudioTest, WithoutSoundThereIsNone) {
  RunFfmpeg(folder_, inputs_ + "-c:v ffv1 silent.mkv");
  EXPECT_FALSE(HasAudio(folder_ / "silent.mkv"));
  EXPECT_THAT(ExtractAudio({folder_ / "silent.mkv"}, wav_).error().message,
              HasSubstr("silent.mkv: holds no sound"));
  EXPECT_FALSE(fs::exists(wav_));
}

}  // namespace
}  // namespace articap
