// SPDX-License-Identifier: MIT
#include "capture/video.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/file_io.h"
#include "tests/capture/ffmpeg_files.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::SizeIs;

// Lossless and without any other frame; or as cameras have it, where the bar is found to a pixel.
constexpr const char* kLossless = "-c:v ffv1 ";
constexpr const char* kAsCameras = "-pix_fmt yuv420p -c:v libx264 -crf 15 -g 12 -bf 2 ";
constexpr double kBarTolerance_px = 0.6;

class VideoTest : public testing::Test {
 protected:
  void SetUp() override { ARTICAP_NEEDS_FFMPEG(); }
  ~VideoTest() override { fs::remove_all(folder_); }

  // Encodes the film and opens what comes out.
  std::unique_ptr<FrameSource> Make(const BarFilm& film, const std::string& arguments,
                                    const std::string& name, const VideoOptions& options = {}) {
    RunFfmpeg(folder_, WriteBars(folder_, film) + arguments + name);
    return Open({name}, options);
  }
  std::unique_ptr<FrameSource> Open(const std::vector<std::string>& names,
                                    const VideoOptions& options = {}) const {
    return OrThrow(OpenVideo(Paths(names), options));
  }
  std::vector<fs::path> Paths(const std::vector<std::string>& names) const {
    std::vector<fs::path> paths;
    for (const std::string& name : names) paths.push_back(folder_ / name);
    return paths;
  }

  const fs::path folder_ = MakeTemporaryFolder("articap_video_test");
};

// Every picture of the film, at its time.
void ExpectFilm(const SeenFilm& seen, const BarFilm& film, double tolerance_s = 1e-9) {
  EXPECT_THAT(seen.errors, IsEmpty());
  ASSERT_THAT(seen.frames, SizeIs(film.num_frames));
  for (int i = 0; i < film.num_frames; ++i) {
    EXPECT_NEAR(seen.frames[i].bar_px, BarOf(film, i), kBarTolerance_px) << "picture " << i;
    EXPECT_NEAR(seen.frames[i].time_s, i / film.rate_hz, tolerance_s) << "picture " << i;
    EXPECT_EQ(seen.frames[i].status, FrameStatus::kGood);
  }
}

TEST_F(VideoTest, PicturesComeInOrderWithTheirTimes) {
  const BarFilm film;
  for (const std::string name : {"a.mp4", "a.mov", "a.mkv", "a.mts", "a.avi"}) {
    // AVI has no times of its own, and frames in another order would have none.
    const auto source = Make(film, kAsCameras + std::string(name == "a.avi" ? "-bf 0 " : ""), name);
    EXPECT_EQ(source->info().width, 160);
    EXPECT_EQ(source->info().height, 64);
    EXPECT_NEAR(source->info().rate_hz, 50, 1e-9) << name;
    EXPECT_FALSE(source->info().interlaced) << name;
    EXPECT_NEAR(static_cast<double>(source->info().frames), 20, 1) << name;
    EXPECT_EQ(OrThrow(CountPictures(folder_ / name, 50)), 20) << name;
    ExpectFilm(ReadAll(*source), film);
    EXPECT_TRUE(source->info().constant_rate) << name;
    EXPECT_THAT(source->info().notes, IsEmpty()) << name;
    ASSERT_TRUE(source->Rewind());
    ExpectFilm(ReadAll(*source), film);
  }
}

TEST_F(VideoTest, RatesAreThoseOfTheHeader) {
  BarFilm film;
  film.num_frames = 31;
  for (const char* rate : {"60000/1001", "24000/1001", "25"}) {
    const std::string ratio = fmt::format("-r {} -c:v libx264 -pix_fmt yuv420p ", rate);
    WriteBars(folder_, film);
    RunFfmpeg(folder_,
              fmt::format("-f rawvideo -pix_fmt gray -s 160x64 -r {} -i bars.gray ", rate) + ratio +
                  "a.mkv");
    const double expected_hz = std::string(rate) == "25" ? 25
                               : rate[0] == '6'          ? 60000 / 1001.0
                                                         : 24000 / 1001.0;
    const auto source = Open({"a.mkv"});
    // Matroska rounds the duration of a frame to nanoseconds.
    EXPECT_NEAR(source->info().rate_hz, expected_hz, 1e-4);
    film.rate_hz = expected_hz;
    ExpectFilm(ReadAll(*source), film, 0.0011);  // and its times to milliseconds
    EXPECT_TRUE(source->info().constant_rate);
  }
}

TEST_F(VideoTest, GrayOfSixteenBitsStaysToTheBit) {
  BarFilm film;
  film.gray16 = true;
  const auto source = Make(film, kLossless, "a.mkv");
  const auto frame = OrThrow(source->Next());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->image.format, PixelFormat::kGray16);
  for (int y = 0; y < film.height; ++y) {
    std::uint16_t value = 0;
    std::memcpy(&value, frame->image.row(y) + 2 * kFirstBar_px, 2);
    EXPECT_EQ(value, 230 * 256 + 17 * y % 256);
  }
}

TEST_F(VideoTest, LumaIsAsTheFileHasIt) {
  // Video of limited range: 230 of 255 becomes 16 + 219 * 230 / 255.
  const auto source = Make({}, "-pix_fmt yuv422p10le " + std::string(kLossless), "a.mkv");
  const auto deep = OrThrow(source->Next());
  EXPECT_EQ(deep->image.format, PixelFormat::kGray16);
  std::uint16_t value = 0;
  std::memcpy(&value, deep->image.row(5) + 2 * kFirstBar_px, 2);
  EXPECT_NEAR(value / 65535.0 * 1023, 4 * (16 + 219 * 230 / 255.0), 1);
  const auto eight = Make({}, "-pix_fmt yuv420p " + std::string(kLossless), "b.mkv");
  const auto frame = OrThrow(eight->Next());
  EXPECT_EQ(frame->image.format, PixelFormat::kGray8);
  EXPECT_NEAR(frame->image.row(5)[kFirstBar_px], 16 + 219 * 230 / 255.0, 1);
}

TEST_F(VideoTest, ColorIsThatOfTheStandard) {
  const std::string colors = "-f lavfi -i color=0xC06030:s=64x48:r=25:d=0.2,format=gbrp ";
  for (const char* coding :
       {"-vf scale=out_color_matrix=bt709 -colorspace bt709 -pix_fmt yuv444p -c:v ffv1 a.mkv",
        "-vf scale=out_color_matrix=bt601 -pix_fmt yuv420p -c:v ffv1 a.mkv",
        "-pix_fmt bgr0 -c:v ffv1 a.mkv"}) {
    RunFfmpeg(folder_, colors + coding);
    VideoOptions options;
    options.color = PixelColor::kRgb;
    const auto source = Open({"a.mkv"}, options);
    const auto frame = OrThrow(source->Next());
    ASSERT_EQ(frame->image.format, PixelFormat::kRgb8);
    for (const int x : {0, 63})
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(frame->image.row(47)[3 * x + channel], (std::array{0xC0, 0x60, 0x30}[channel]),
                    2)
            << coding;
  }
}

struct Weave {
  const char* description;
  const char* filter;  // makes pictures of 25 Hz from 50 of a second
  const char* flags;   // what the file is to say
  bool is_noted;
};

TEST_F(VideoTest, FieldsComeAtTheirTimes) {
  BarFilm film;
  film.num_frames = 32;
  film.step_px = 3;
  const char* const kTop = "-vf interlace=scan=tff:lowpass=off ";
  const char* const kBottom = "-vf interlace=scan=bff:lowpass=off ";
  const char* const kSmoothed = "-vf interlace=scan=tff:lowpass=linear ";
  for (const Weave& weave : {
           Weave{"top first", kTop, "-flags +ildct+ilme -top 1 ", false},
           Weave{"bottom first", kBottom, "-flags +ildct+ilme -top 0 ", false},
           Weave{"smoothed across the rows", kSmoothed, "-flags +ildct+ilme -top 1 ", false},
           Weave{"not flagged", "-vf interlace=scan=tff:lowpass=off,setfield=prog ", "", true},
           Weave{"not flagged, bottom first", "-vf interlace=scan=bff:lowpass=off,setfield=prog ",
                 "", true},
           Weave{"flagged the wrong way", "-vf interlace=scan=bff:lowpass=off,setfield=tff ",
                 "-flags +ildct+ilme -top 1 ", true},
       }) {
    SCOPED_TRACE(weave.description);
    const bool bottom_first = std::string(weave.filter).find("bff") != std::string::npos;
    for (const std::string coding :
         {"-pix_fmt yuv420p -c:v mpeg2video -q:v 2 ", "-pix_fmt yuv420p -c:v libx264 -crf 12 "}) {
      const bool smoothed = std::string(weave.filter).find("linear") != std::string::npos;
      const auto source = Make(film, weave.filter + coding + weave.flags, "a.mts");
      EXPECT_TRUE(source->info().interlaced);
      EXPECT_NEAR(source->info().rate_hz, 50, 1e-9);
      EXPECT_EQ(source->info().height, 64);
      const SeenFilm seen = ReadAll(*source);
      ExpectFilm(seen, film);
      EXPECT_THAT(source->info().notes, SizeIs(weave.is_noted ? 2 : 1));
      ASSERT_THAT(seen.frames, SizeIs(32));
      for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(seen.frames[i].height, 32);
        const double first_row = bottom_first == (i == 0) ? 1 : 0;
        EXPECT_EQ(seen.frames[i].picture_from_image.scale, Eigen::Vector2d(1, 2));
        EXPECT_EQ(seen.frames[i].picture_from_image.offset_px, Eigen::Vector2d(0, first_row));
      }
      if (smoothed) break;
    }
  }
}

TEST_F(VideoTest, WholePicturesThatAreFlaggedInterlacedStayWhole) {
  const BarFilm film;
  const auto source = Make(film,
                           "-vf setfield=tff -pix_fmt yuv420p -c:v libx264 -crf 12 "
                           "-flags +ildct+ilme ",
                           "a.mts");
  EXPECT_FALSE(source->info().interlaced);
  EXPECT_THAT(source->info().notes, ElementsAre(HasSubstr("nothing that moves")));
  ExpectFilm(ReadAll(*source), film);
}

TEST_F(VideoTest, WithoutMovementTheFileDecidesAndTheOptionOverrules) {
  BarFilm film;
  film.step_px = 0;
  const auto source =
      Make(film, "-vf setfield=bff -pix_fmt yuv420p -c:v libx264 -flags +ildct+ilme ", "a.mkv");
  EXPECT_TRUE(source->info().interlaced);
  EXPECT_THAT(source->info().notes,
              ElementsAre(AllOf(HasSubstr("bottom field first"), HasSubstr("too little moves"))));
  EXPECT_EQ(OrThrow(source->Next())->picture_from_image.offset_px.y(), 1);
  VideoOptions options;
  options.fields = FieldMode::kTopFirst;
  EXPECT_EQ(OrThrow(Open({"a.mkv"}, options)->Next())->picture_from_image.offset_px.y(), 0);
  options.fields = FieldMode::kFrames;
  EXPECT_EQ(OrThrow(Open({"a.mkv"}, options)->Next())->image.height, 64);
}

TEST_F(VideoTest, ChangingRatesKeepTheirTimes) {
  BarFilm film;
  const auto source = Make(film,
                           "-vf \"settb=1/1000,setpts='(N+0.5*not(mod(N,3)))/50/TB'\" -vsync "
                           "passthrough -enc_time_base 1/1000 " +
                               std::string(kAsCameras),
                           "a.mkv");
  const SeenFilm seen = ReadAll(*source);
  ASSERT_THAT(seen.frames, SizeIs(20));
  EXPECT_FALSE(source->info().constant_rate);
  EXPECT_THAT(source->info().notes, Contains(HasSubstr("constant rate")));
  for (int i = 0; i < 20; ++i) {
    const double own_s = (i + (i % 3 == 0 ? 0.5 : 0)) / 50;
    EXPECT_NEAR(seen.frames[i].time_s, own_s - 0.01, 0.0011);
    EXPECT_NEAR(seen.frames[i].bar_px, BarOf(film, i), kBarTolerance_px);
  }
}

TEST_F(VideoTest, LostFramesLeaveAGap) {
  const BarFilm film;
  const auto source =
      Make(film,
           "-vf \"select='not(between(n,7,9))'\" -vsync passthrough -enc_time_base 1/1000 " +
               std::string(kAsCameras),
           "a.mp4");
  const SeenFilm seen = ReadAll(*source);
  ASSERT_THAT(seen.frames, SizeIs(17));
  EXPECT_NEAR(seen.frames[7].bar_px, BarOf(film, 10), kBarTolerance_px);
  EXPECT_NEAR(seen.frames[7].time_s, 10 / film.rate_hz, 1e-9);
  EXPECT_THAT(source->info().notes, ElementsAre(HasSubstr("1 gaps")));
}

// ffmpeg writes its argument, in degrees, as a turn against the clock.
std::string Turn(int clockwise_deg) {
  return fmt::format("-i flat.mp4 -c copy -metadata:s:v:0 rotate={} turned.mp4",
                     (360 - clockwise_deg) % 360);
}

TEST_F(VideoTest, PicturesAreTurnedAsTheFileAsks) {
  const BarFilm film;
  RunFfmpeg(folder_, WriteBars(folder_, film) + kAsCameras + "flat.mp4");
  for (const int clockwise_deg : {90, 180, 270}) {
    SCOPED_TRACE(clockwise_deg);
    RunFfmpeg(folder_, Turn(clockwise_deg));
    const auto source = Open({"turned.mp4"});
    const bool quarter = clockwise_deg != 180;
    EXPECT_EQ(source->info().width, quarter ? 64 : 160);
    EXPECT_EQ(source->info().height, quarter ? 160 : 64);
    EXPECT_THAT(source->info().notes,
                ElementsAre(HasSubstr(fmt::format("{} degrees clockwise", clockwise_deg))));
    const SeenFilm seen = ReadAll(*source, quarter);
    ASSERT_THAT(seen.frames, SizeIs(20));
    for (int i = 0; i < 20; ++i) {
      const double along = clockwise_deg == 90 ? BarOf(film, i) : 159 - BarOf(film, i);
      EXPECT_NEAR(seen.frames[i].bar_px, along, kBarTolerance_px);
      EXPECT_EQ(seen.frames[i].width, quarter ? 64 : 160);
      EXPECT_TRUE(seen.frames[i].picture_from_image.is_identity());
    }
    // Players show the same, to the pixel.
    RunFfmpeg(folder_, "-i turned.mp4 -c:v ffv1 played.mkv");
    const auto played = Open({"played.mkv"});
    ASSERT_TRUE(source->Rewind());
    const ImageView ours = OrThrow(source->Next())->image;
    const ImageView theirs = OrThrow(played->Next())->image;
    ASSERT_EQ(theirs.width, ours.width);
    for (int y = 0; y < ours.height; ++y)
      EXPECT_EQ(std::memcmp(ours.row(y), theirs.row(y), static_cast<std::size_t>(ours.width)), 0);
  }
}

TEST_F(VideoTest, FieldsOfTurnedPicturesLieWhereTheirRowsAre) {
  BarFilm film;
  film.num_frames = 32;
  RunFfmpeg(folder_, WriteBars(folder_, film) +
                         "-vf interlace=scan=tff:lowpass=off -pix_fmt yuv420p -c:v libx264 -crf 12 "
                         "-flags +ildct+ilme flat.mp4");
  const std::array<Eigen::Vector2d, 4> scales = {{{1, 2}, {2, 1}, {1, 2}, {2, 1}}};
  // The top field's rows are 0, 2, ..., 62 of 64, from the left, the top or the other end.
  const std::array<Eigen::Vector2d, 4> offsets = {{{0, 0}, {1, 0}, {0, 1}, {0, 0}}};
  for (const int turns : {0, 1, 2, 3}) {
    RunFfmpeg(folder_, Turn(90 * turns));
    const auto frame = OrThrow(Open({"turned.mp4"})->Next());
    EXPECT_EQ(frame->picture_from_image.scale, scales[turns]);
    EXPECT_EQ(frame->picture_from_image.offset_px, offsets[turns]);
  }
}

TEST_F(VideoTest, PixelsThatAreNotSquareHaveTheirScale) {
  const BarFilm film;
  for (const auto& [aspect, scale] : {std::pair{"16/15", 16 / 15.0}, {"4/3", 4 / 3.0}}) {
    const auto source = Make(film, fmt::format("-vf setsar={} ", aspect) + kAsCameras, "a.mkv");
    EXPECT_EQ(source->info().width, std::lround(160 * scale));
    EXPECT_EQ(source->info().height, 64);
    const auto frame = OrThrow(source->Next());
    EXPECT_EQ(frame->image.width, 160);
    const PictureFromImage picture = frame->picture_from_image;
    EXPECT_NEAR(picture.scale.x(), scale, 1e-9);
    EXPECT_EQ(picture.scale.y(), 1);
    // The edges of the image are the edges of the picture.
    EXPECT_NEAR((picture * Eigen::Vector2d(-0.5, 0)).x(), -0.5, 1e-9);
    EXPECT_NEAR((picture * Eigen::Vector2d(159.5, 0)).x(), 160 * scale - 0.5, 1e-9);
  }
}

TEST_F(VideoTest, PartsAreOneVideo) {
  BarFilm film;
  film.num_frames = 36;
  film.step_px = 3;
  for (const std::string ending : {"mts", "mkv", "mp4"})
    for (const int reset : {0, 1}) {
      SCOPED_TRACE(ending + (reset == 1 ? ", clocks that begin anew" : ""));
      RunFfmpeg(folder_, WriteBars(folder_, film) + kAsCameras +
                             fmt::format("-f segment -segment_time 0.2 -reset_timestamps {} "
                                         "-segment_format {} part%d.{}",
                                         reset,
                                         ending == "mts"   ? "mpegts"
                                         : ending == "mkv" ? "matroska"
                                                           : ending,
                                         ending));
      const auto source = Open({"part0." + ending, "part1." + ending, "part2." + ending});
      ExpectFilm(ReadAll(*source), film, 1e-6);
      EXPECT_TRUE(source->info().constant_rate);
    }
}

// As camcorders cut them: anywhere, even within a picture.
TEST_F(VideoTest, PartsOfATransportStreamMayBeCutWithinAPicture) {
  BarFilm film;
  film.num_frames = 36;
  film.step_px = 3;
  RunFfmpeg(folder_, WriteBars(folder_, film) + kAsCameras + "whole.mts");
  const std::string bytes = OrThrow(ReadFile(folder_ / "whole.mts"));
  const std::size_t middle = bytes.size() / 2 / 188 * 188;
  ASSERT_TRUE(WriteFile(folder_ / "00001.mts", bytes.substr(0, middle)));
  ASSERT_TRUE(WriteFile(folder_ / "00002.mts", bytes.substr(middle)));
  ExpectFilm(ReadAll(*Open({"00001.mts", "00002.mts"})), film);
}

TEST_F(VideoTest, WhatIsNoPartIsRefused) {
  BarFilm film;
  RunFfmpeg(folder_, WriteBars(folder_, film) + kAsCameras + "a.mp4");
  film.rate_hz = 25;
  RunFfmpeg(folder_, WriteBars(folder_, film) + kAsCameras + "slow.mp4");
  film.rate_hz = 50;
  film.width = 192;
  RunFfmpeg(folder_, WriteBars(folder_, film) + kAsCameras + "wide.mp4");
  EXPECT_THAT(OpenVideo(Paths({"a.mp4", "slow.mp4"})).error().message,
              AllOf(HasSubstr("slow.mp4 is 160x64 h264 yuv420p at 25 Hz"), HasSubstr("not parts")));
  EXPECT_THAT(OpenVideo(Paths({"a.mp4", "wide.mp4"})).error().message, HasSubstr("192x64"));
  EXPECT_THAT(OpenVideo({}).error().message, HasSubstr("no video"));
  EXPECT_THAT(OpenVideo(Paths({"none.mp4"})).error().message, HasSubstr("none.mp4"));
  for (const std::string& bytes : {std::string(), std::string("hello"), std::string(5000, '\0'),
                                   std::string("#EXTM3U\n#EXTINF:1\na.mp4\n")}) {
    ASSERT_TRUE(WriteFile(folder_ / "no.mp4", bytes));
    EXPECT_THAT(OpenVideo(Paths({"no.mp4"})).error().message, HasSubstr("no.mp4"));
  }
}

TEST_F(VideoTest, OfAFileThatWasCutShortComesWhatIsThere) {
  BarFilm film;
  film.num_frames = 30;
  const std::string intra = "-c:v mjpeg -pix_fmt yuvj420p -q:v 3 ";
  for (const std::string name : {"a.mkv", "a.avi", "a.ts", "a.mp4"}) {
    SCOPED_TRACE(name);
    const std::string coding = name == "a.ts"
                                   ? "-pix_fmt yuv420p -c:v mpeg2video -g 1 -q:v 3 "
                                   : intra + (name == "a.mp4" ? "-movflags +faststart " : "");
    RunFfmpeg(folder_, WriteBars(folder_, film) + coding + name);
    std::string bytes = OrThrow(ReadFile(folder_ / name));
    bytes.resize(bytes.size() * 6 / 10);
    ASSERT_TRUE(WriteFile(folder_ / name, bytes));
    const auto source = Open({name});
    const SeenFilm seen = ReadAll(*source);
    ASSERT_GE(seen.frames.size(), 10);
    EXPECT_LT(seen.frames.size(), 25);
    for (std::size_t i = 0; i + 1 < seen.frames.size(); ++i) {
      EXPECT_NEAR(seen.frames[i].bar_px, BarOf(film, static_cast<int>(i)), kBarTolerance_px);
      EXPECT_EQ(seen.frames[i].status, FrameStatus::kGood);
    }
    // The picture in which it ends is none, or is marked, and somebody is told.
    const bool is_marked = seen.frames.back().status == FrameStatus::kCorrupt;
    EXPECT_TRUE(is_marked || !seen.errors.empty() || !source->info().notes.empty());
    for (const std::string& error : seen.errors) EXPECT_THAT(error, HasSubstr(name));
  }
}

TEST_F(VideoTest, DamagedFramesAreNamedAndTheOthersCome) {
  BarFilm film;
  film.num_frames = 30;
  RunFfmpeg(folder_, WriteBars(folder_, film) + "-c:v ffv1 -level 3 -slicecrc 1 -g 1 a.mkv");
  std::string bytes = OrThrow(ReadFile(folder_ / "a.mkv"));
  for (std::size_t i = 0; i < 40; ++i) bytes[bytes.size() / 2 + i] ^= 0x55;
  ASSERT_TRUE(WriteFile(folder_ / "a.mkv", bytes));
  const SeenFilm seen = ReadAll(*Open({"a.mkv"}));
  EXPECT_GE(seen.frames.size(), 28);
  const auto num_corrupt =
      std::count_if(seen.frames.begin(), seen.frames.end(),
                    [](const SeenFrame& frame) { return frame.status == FrameStatus::kCorrupt; });
  EXPECT_THAT(num_corrupt + static_cast<long>(seen.errors.size()), AllOf(Ge(1), Le(2)));
  // The times tell what is missing.
  EXPECT_NEAR(seen.frames.back().time_s, 29 / film.rate_hz, 1e-9);
  EXPECT_NEAR(seen.frames.back().bar_px, BarOf(film, 29), kBarTolerance_px);
}

TEST_F(VideoTest, AnotherSizeEndsTheVideo) {
  BarFilm film;
  RunFfmpeg(folder_, WriteBars(folder_, film) + "-pix_fmt yuv420p -c:v mpeg2video -q:v 2 a.ts");
  film.width = 192;
  RunFfmpeg(folder_, WriteBars(folder_, film) + "-pix_fmt yuv420p -c:v mpeg2video -q:v 2 b.ts");
  ASSERT_TRUE(WriteFile(folder_ / "both.ts",
                        OrThrow(ReadFile(folder_ / "a.ts")) + OrThrow(ReadFile(folder_ / "b.ts"))));
  const SeenFilm seen = ReadAll(*Open({"both.ts"}));
  // The decoder may drop the frame that it holds back.
  EXPECT_GE(seen.frames.size(), 19);
  EXPECT_LE(seen.frames.size(), 20);
  ASSERT_THAT(seen.errors, SizeIs(1));
  EXPECT_THAT(seen.errors[0],
              AllOf(HasSubstr(fmt::format("both.ts, frame {}: ", seen.frames.size())),
                    HasSubstr("160x64"), HasSubstr("192x64")));
}

TEST_F(VideoTest, TheFirstFrameIsWhereTheVideoBegins) {
  VideoOptions options;
  options.start = SessionTimeFromSeconds(-1.5);
  const auto source = Make({}, kAsCameras, "a.mts", options);
  EXPECT_EQ(SecondsOf(OrThrow(source->Next())->time), -1.5);
}

}  // namespace
}  // namespace articap
