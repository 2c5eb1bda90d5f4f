// SPDX-License-Identifier: MIT
// Marker files that are cut, damaged or meant to do harm: each is read in part, with a warning, or
// refused with a message; none makes the reader crash or ask for memory that the file cannot fill.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/file_io.h"
#include "fuzz/marker_target.h"
#include "tests/core/c3d_builder.h"
#include "tests/core/marker_fixtures.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::HasSubstr;

// Reads it either way; what is read must be in proportion to the file.
void ExpectHarmless(const std::string& bytes, const std::string& what) {
  MarkerReadOptions options;
  options.unit = "mm";
  options.rate_hz = 100;
  for (const MarkerReadOptions& each : {MarkerReadOptions(), options}) {
    const auto recording = Parse(bytes, "hostile", each);
    if (!recording) {
      EXPECT_FALSE(recording.error().message.empty()) << what;
      continue;
    }
    const double samples = double(recording->tracks.num_frames()) * recording->tracks.num_markers();
    EXPECT_LE(samples, 1e6 + 64.0 * double(bytes.size())) << what;
  }
}

std::string SmallC3d() {
  C3dBuilder builder;
  builder.num_channels = 2;
  builder.samples_per_frame = 2;
  builder.SetNumbers("ANALOG", "SCALE", 4, {1, 2});
  builder.SetNumbers("ANALOG", "OFFSET", 2, {0, 1});
  builder.SetNumbers("EVENT", "USED", 2, {1});
  builder.SetNumbers("EVENT", "TIMES", 4, {0, 1}, {2, 1});
  builder.SetTexts("EVENT", "LABELS", {"begin"});
  builder.SetNumbers("TRIAL", "ACTUAL_START_FIELD", 2, {1, 0});
  builder.SetNumbers("TRIAL", "ACTUAL_END_FIELD", 2, {5, 0});
  return builder.Build();
}

TEST(HostileC3dTest, CutAtEveryByte) {
  const std::string whole = SmallC3d();
  for (std::size_t size = 0; size < whole.size(); ++size)
    ExpectHarmless(whole.substr(0, size), "cut to " + std::to_string(size));
}

TEST(HostileC3dTest, EveryByteOfHeaderAndParametersWrong) {
  const std::string whole = SmallC3d();
  for (std::size_t at = 0; at < 1024; ++at)
    for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
      std::string wrong = whole;
      wrong[at] = static_cast<char>(value);
      ExpectHarmless(wrong, "byte " + std::to_string(at) + " is " + std::to_string(value));
    }
}

TEST(HostileC3dTest, CountsThatTheFileCannotHold) {
  C3dBuilder builder;
  builder.header_words = {{2, 65535}, {4, 65535}, {18, 1}, {6, 0}, {8, 65535}};
  ExpectHarmless(builder.Build(), "all counts at their largest");
  builder.header_words = {{8, 65535}};
  builder.SetNumbers("TRIAL", "ACTUAL_START_FIELD", 2, {0, 0});
  builder.SetNumbers("TRIAL", "ACTUAL_END_FIELD", 2, {65535, 65535});
  const MarkerRecording recording = ParseOrThrow(builder.Build());
  EXPECT_LT(recording.tracks.num_frames(), 20);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("cut short"));
  builder.SetNumbers("POINT", "LONG_FRAMES", 4, {1e38});
  builder.SetNumbers("EVENT", "USED", 4, {1e30});
  builder.SetNumbers("EVENT", "TIMES", 4, {0, 1}, {2, 1});
  ExpectHarmless(builder.Build(), "floats for counts");
}

TEST(HostileC3dTest, ParametersThatPointAnywhere) {
  std::string bytes = SmallC3d();
  // The distance to the next record stands behind each name: 1 leads into itself.
  for (const char* name : {"LABELS", "UNITS", "SCALE", "TIMES"})
    for (const int distance : {0, 1, 2, 3, 0x7FFF, 0x8000, 0xFFFF}) {
      std::string wrong = bytes;
      const std::size_t at = wrong.find(name) + std::string(name).size();
      wrong[at] = static_cast<char>(distance & 0xFF);
      wrong[at + 1] = static_cast<char>(distance >> 8);
      ExpectHarmless(wrong, std::string(name) + " points to " + std::to_string(distance));
    }
  // Dimensions whose product is astronomical.
  C3dBuilder builder;
  builder.SetNumbers("POINT", "MANY", 4, {1}, {255, 255, 255, 255, 255, 255, 255});
  ExpectHarmless(builder.Build(), "dimensions");
}

TEST(HostileTextTest, CutAtEveryByte) {
  for (const MarkerFormat format : AllFormats()) {
    if (format == MarkerFormat::kC3d) continue;
    const std::string whole = FormatMarkers(SmallRecording(), format);
    for (std::size_t size = 0; size <= whole.size(); ++size)
      ExpectHarmless(whole.substr(0, size),
                     std::string(NameOf(format)) + " cut to " + std::to_string(size));
  }
}

TEST(HostileTextTest, EveryByteWrong) {
  for (const MarkerFormat format : AllFormats()) {
    if (format == MarkerFormat::kC3d) continue;
    const std::string whole = FormatMarkers(SmallRecording(), format);
    for (std::size_t at = 0; at < whole.size(); ++at)
      for (const char value : {'\0', '\n', '\t', ',', '"', '9', '\xFF'}) {
        std::string wrong = whole;
        wrong[at] = value;
        ExpectHarmless(wrong, std::string(NameOf(format)) + " byte " + std::to_string(at));
      }
  }
}

TEST(HostileTextTest, HeadersThatPromiseTooMuch) {
  ExpectHarmless("NO_OF_MARKERS\t65535\nFREQUENCY\t100\nMARKER_NAMES\n" + std::string(20000, '\n'),
                 "tsv");
  std::string rows;
  for (int i = 0; i < 20000; ++i) rows += "1\n";
  ExpectHarmless("NO_OF_MARKERS\t60000\nFREQUENCY\t100\nMARKER_NAMES\n" + rows, "tsv with rows");
  std::string header = "frame,time_s";
  for (int i = 0; i < 5000; ++i)
    for (const char* axis : {"_x_mm", "_y_mm", "_z_mm"})
      (header += ",m") += std::to_string(i) + axis;
  EXPECT_THAT(FailureOf(header + "\n" + rows), HasSubstr("far shorter"));
  ExpectHarmless("frame,time_s,a_x_mm,a_y_mm,a_z_mm\n1,0,1,1,1\n2000000000,1e9,1,1,1\n", "frames");
  ExpectHarmless("frame,time_s,a_x_mm,a_y_mm,a_z_mm\n-1e300,-1e300,1,1,1\n1e300,1e300,1,1,1\n",
                 "numbers");
  ExpectHarmless(
      "PathFileType\nDataRate\tNumFrames\tNumMarkers\tUnits\n1e300\t1e300\t-1\tmm\n"
      "Frame#\tTime\ta\n",
      "trc");
}

// What fuzzing found once, and the seeds it began with.
TEST(MarkerCorpusTest, EveryFileIsReadOrRefusedAndRewrittenTheSame) {
  int num_files = 0;
  for (const char* name : {"c3d", "csv", "trc", "tsv"}) {
    const std::filesystem::path folder = SourceFolder() / "fuzz" / "corpus" / name;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      SCOPED_TRACE(entry.path().string());
      const auto bytes = ReadFile(entry.path());
      ASSERT_TRUE(bytes);
      CheckMarkerBytes(std::as_bytes(std::span(*bytes)), (std::string("corpus.") + name).c_str(),
                       AllFormats());
      ++num_files;
    }
  }
  EXPECT_GE(num_files, 20);
}

}  // namespace
}  // namespace articap
