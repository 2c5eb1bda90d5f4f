// SPDX-License-Identifier: MIT
#include "core/marker_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "core/file_io.h"
#include "core/io/marker_info.h"
#include "tests/core/marker_fixtures.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// States, and positions within a tolerance.
void ExpectSameSamples(const StageTracks& actual, const StageTracks& expected,
                       double tolerance_mm) {
  ASSERT_EQ(actual.num_frames(), expected.num_frames());
  ASSERT_EQ(actual.num_markers(), expected.num_markers());
  for (int frame = 0; frame < expected.num_frames(); ++frame)
    for (int marker = 0; marker < expected.num_markers(); ++marker) {
      ASSERT_EQ(actual.is_missing(frame, marker), expected.is_missing(frame, marker))
          << frame << " " << marker;
      if (expected.is_missing(frame, marker)) continue;
      ASSERT_THAT(actual.position_mm(frame, marker),
                  PointNear(expected.position_mm(frame, marker), tolerance_mm));
    }
}

class MarkerFormatTest : public testing::TestWithParam<MarkerFormat> {
 protected:
  static std::string Write(const MarkerRecording& recording) {
    return FormatMarkers(recording, GetParam());
  }
};

INSTANTIATE_TEST_SUITE_P(All, MarkerFormatTest, testing::ValuesIn(AllFormats()),
                         [](const auto& each) { return std::string(NameOf(each.param)); });

// write(read(write(x))) == write(x), and nothing that reading would have to repair.
void ExpectStable(const MarkerRecording& recording, MarkerFormat format) {
  const std::string once = FormatMarkers(recording, format);
  const auto read = Parse(once);
  ASSERT_TRUE(read) << NameOf(format) << ": " << read.error().message;
  EXPECT_EQ(FormatMarkers(*read, format), once) << NameOf(format);
  ExpectSameSamples(read->tracks, recording.tracks, 2e-4);
}

TEST_P(MarkerFormatTest, WrittenAgainIsTheSameToTheByte) {
  const MarkerRecording recording = SmallRecording();
  ExpectStable(recording, GetParam());
  EXPECT_THAT(ParseOrThrow(Write(recording)).warnings, IsEmpty());
}

TEST_P(MarkerFormatTest, WrittenAgainIsTheSameOverAllExtremes) {
  std::vector<MarkerRecording> recordings(7);
  recordings[0].tracks = StageTracks({}, 0, 100);
  recordings[1].tracks = StageTracks({"a"}, 0, 100, 0);
  recordings[2].tracks = StageTracks({"a", "b"}, 3, 1e6 / 7);  // all missing
  recordings[3].tracks = StageTracks({"a"}, 1, 0.5, 70000, SessionTimeFromSeconds(0.123456789));
  recordings[3].tracks.Set(0, 0, {1e-9, -1e-9, 0});
  recordings[4].tracks = StageTracks({"", "*", "x,y", "\"q\"", "q\"", "x,y", "a\tb\n"}, 2, 29.97);
  for (int i = 0; i < 7; ++i) recordings[4].tracks.Set(1, i, {1.0 + i, 2, 3});
  recordings[5].tracks = StageTracks({"a"}, 2, 25, 1, SessionTimeFromSeconds(-1.5));
  recordings[5].tracks.Set(1, 0, {1e12 / 3, -123456789.123456789, 1e-4 / 3});
  recordings[6].tracks = StageTracks({"Anna:*7", "Anna:b:c"}, 1, 59.94005994005994);
  recordings[6].tracks.Set(0, 0, {1, 2, 3}, SampleState::kFilled);
  recordings[6].tracks.Set(0, 1, {1, 2, 3});
  for (const MarkerRecording& recording : recordings) {
    const std::string once = Write(recording);
    const auto read = Parse(once);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(FormatMarkers(*read, GetParam()), once);
    EXPECT_EQ(read->tracks.num_frames(), recording.tracks.num_frames());
    EXPECT_EQ(read->tracks.num_markers(), recording.tracks.num_markers());
  }
}

TEST_P(MarkerFormatTest, WrittenAgainIsTheSameForRandomRecordings) {
  std::mt19937 random(11);
  std::normal_distribution<double> coordinate(0, 300);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int round = 0; round < 30; ++round) {
    const int num_markers = 1 + round % 9;
    std::vector<std::string> names;
    for (int i = 0; i < num_markers; ++i) names.emplace_back(1, static_cast<char>('a' + i));
    MarkerRecording recording;
    const double rate_hz = 10 + 200 * uniform(random);
    const int first_frame = round % 3 == 0 ? 1 : static_cast<int>(1000 * uniform(random));
    recording.tracks = StageTracks(names, 40, rate_hz, first_frame,
                                   TimeOfFrame(std::max(first_frame, 1) - 1, rate_hz));
    const bool has_residuals = round % 2 == 0;
    for (int frame = 0; frame < 40; ++frame)
      for (int i = 0; i < num_markers; ++i) {
        const bool is_missing = uniform(random) < 0.2;
        if (!is_missing)
          recording.tracks.Set(
              frame, i, {coordinate(random), coordinate(random), coordinate(random)},
              uniform(random) < 0.1 ? SampleState::kFilled : SampleState::kMeasured);
        if (has_residuals)
          recording.residuals_mm.push_back(static_cast<float>(3 * uniform(random)));
      }
    ExpectStable(recording, GetParam());
  }
}

TEST_P(MarkerFormatTest, LongFilesKeepEveryFrame) {
  MarkerRecording recording;
  recording.tracks = StageTracks({"a"}, 70000, 120);
  for (int frame = 0; frame < 70000; frame += 2)
    recording.tracks.Set(frame, 0, {0.001 * frame, 1, 2});
  ExpectStable(recording, GetParam());
}

TEST_P(MarkerFormatTest, ManyMarkersKeepTheirNames) {
  std::vector<std::string> names;
  for (int i = 0; i < 700; ++i) names.push_back(std::to_string(i) + " marker");
  MarkerRecording recording;
  recording.tracks = StageTracks(names, 1, 100);
  for (int i = 0; i < 700; ++i) recording.tracks.Set(0, i, {1.0 * i, 5, 6});
  recording.descriptions = names;
  ExpectStable(recording, GetParam());
  EXPECT_EQ(ParseOrThrow(Write(recording)).tracks.names(), names);
}

TEST_P(MarkerFormatTest, CarriesSubjectRateStartAndFrameNumbers) {
  const MarkerRecording recording = ParseOrThrow(Write(SmallRecording()));
  EXPECT_EQ(recording.subject, "Anna");
  EXPECT_THAT(recording.tracks.names(), ElementsAre("brow", "chin", "lip upper"));
  EXPECT_EQ(recording.tracks.rate_hz(), 59.94);
  EXPECT_EQ(recording.tracks.first_frame(), 11);
  EXPECT_EQ(recording.tracks.start(), TimeOfFrame(10, 59.94));
}

TEST_P(MarkerFormatTest, MissingSamplesStayMissingOnTheWayThroughEveryOther) {
  MarkerRecording recording = SmallRecording();
  for (const MarkerFormat first : AllFormats()) {
    const MarkerRecording between = ParseOrThrow(FormatMarkers(recording, first));
    const MarkerRecording after = ParseOrThrow(Write(between));
    ExpectSameSamples(after.tracks, recording.tracks, 2e-4);
  }
}

// Golden files: the bytes that each format is written with, and what is read of them. To renew them
// after a deliberate change, run the test with ARTICAP_UPDATE_GOLDEN=1 and read the difference.
TEST_P(MarkerFormatTest, AgreesWithTheGoldenFile) {
  const char* const ending = GetParam() == MarkerFormat::kNexusCsv    ? "nexus.csv"
                             : GetParam() == MarkerFormat::kMotiveCsv ? "motive.csv"
                                                                      : NameOf(GetParam());
  const std::filesystem::path path =
      SourceFolder() / "tests" / "golden" / (std::string("markers.") + ending);
  const MarkerRecording recording = SmallRecording();
  if (std::getenv("ARTICAP_UPDATE_GOLDEN")) {
    ASSERT_TRUE(WriteFile(path, Write(recording)));
  }
  const auto golden = ReadFile(path);
  ASSERT_TRUE(golden) << golden.error().message;
  EXPECT_EQ(Write(recording), *golden);
  const auto read = ReadMarkers(path);
  ASSERT_TRUE(read) << read.error().message;
  ExpectSameSamples(read->tracks, recording.tracks, 2e-4);
  EXPECT_EQ(*MarkerFormatOf(path), GetParam());
}

TEST_P(MarkerFormatTest, SpeaksOfEveryLoss) {
  const std::string losses = Joined(LossesOf(SmallRecording(), GetParam()));
  const bool is_c3d = GetParam() == MarkerFormat::kC3d;
  for (const char* what : {"residuals", "camera masks", "descriptions", "analog", "Filled"})
    EXPECT_EQ(losses.find(what) == std::string::npos, is_c3d) << what << " in " << losses;
  if (GetParam() == MarkerFormat::kQualisysTsv)
    EXPECT_THAT(losses, HasSubstr("Of the events only labels and times"));
  else
    EXPECT_EQ(losses.find("events are not kept") == std::string::npos, is_c3d);
  MarkerRecording bare;
  bare.tracks = StageTracks({"a"}, 1, 100);
  bare.tracks.Set(0, 0, {1, 2, 3});
  EXPECT_THAT(LossesOf(bare, GetParam()), IsEmpty());
  bare.tracks.Set(0, 0, {1.00004321, 2, 4000.1}, SampleState::kMeasured, 0.1F);
  EXPECT_THAT(LossesOf(bare, GetParam()), Contains(HasSubstr("rounded")));
  EXPECT_THAT(LossesOf(bare, GetParam()), Contains(HasSubstr("standard deviations")));
  bare.tracks = StageTracks({"a\nb", "a b"}, 1, 100, 1, SessionTimeFromSeconds(2.0000004));
  EXPECT_THAT(LossesOf(bare, GetParam()), Contains(HasSubstr("names change")));
  EXPECT_THAT(LossesOf(bare, GetParam()), Contains(HasSubstr("first frame's time changes")));
}

TEST(C3dWriterTest, RecordingsBeyondTheFormatAreNamed) {
  MarkerRecording recording;
  std::vector<std::string> names;
  for (int i = 0; i < 65536; ++i) names.push_back(std::to_string(i));
  recording.tracks = StageTracks(names, 1, 100);
  EXPECT_THAT(LimitExceeded(recording, MarkerFormat::kC3d).value(), HasSubstr("65536 markers"));
  EXPECT_FALSE(LimitExceeded(recording, MarkerFormat::kPlainCsv));
  recording.tracks = StageTracks({"a"}, 1, 100);
  EXPECT_FALSE(LimitExceeded(recording, MarkerFormat::kC3d));
  for (int i = 0; i < 9000; ++i)
    recording.events.push_back({.time_s = 0.001 * i, .label = "an event of " + std::to_string(i)});
  EXPECT_THAT(LimitExceeded(recording, MarkerFormat::kC3d).value(), HasSubstr("events"));
}

TEST(C3dWriterTest, KeepsEverythingOfARecording) {
  const MarkerRecording recording = SmallRecording();
  const MarkerRecording read = ParseOrThrow(FormatMarkers(recording, MarkerFormat::kC3d));
  for (int frame = 0; frame < 5; ++frame)
    for (int marker = 0; marker < 3; ++marker)
      EXPECT_EQ(read.tracks.state(frame, marker), recording.tracks.state(frame, marker));
  for (std::size_t i = 0; i < recording.residuals_mm.size(); ++i) {
    if (std::isnan(recording.residuals_mm[i])) {
      EXPECT_TRUE(std::isnan(read.residuals_mm[i]));
    } else {
      EXPECT_EQ(read.residuals_mm[i], recording.residuals_mm[i]);
    }
  }
  EXPECT_EQ(read.camera_masks, recording.camera_masks);
  EXPECT_EQ(read.descriptions, recording.descriptions);
  ASSERT_EQ(read.events.size(), 2U);
  EXPECT_EQ(read.events[0].description, "first word");
  EXPECT_EQ(read.events[0].context, "General");
  EXPECT_DOUBLE_EQ(read.events[1].time_s, 61.125);
  ASSERT_EQ(read.analog.channels.size(), 2U);
  EXPECT_EQ(read.analog.samples_per_frame, 2);
  EXPECT_EQ(read.analog.channels[0].samples, recording.analog.channels[0].samples);
  EXPECT_EQ(read.analog.channels[0].unit, "V");
}

TEST(C3dWriterTest, TellsFilledFromMeasuredWithoutResiduals) {
  MarkerRecording recording;
  recording.tracks = StageTracks({"a"}, 3, 100);
  recording.tracks.Set(0, 0, {1, 2, 3});
  recording.tracks.Set(1, 0, {1, 2, 3}, SampleState::kFilled);
  recording.tracks.Set(2, 0, {0, 0, 0}, SampleState::kFilled);
  const MarkerRecording read = ParseOrThrow(FormatMarkers(recording, MarkerFormat::kC3d));
  EXPECT_EQ(read.tracks.state(0, 0), SampleState::kMeasured);
  EXPECT_EQ(read.tracks.state(1, 0), SampleState::kFilled);
  EXPECT_EQ(read.tracks.state(2, 0), SampleState::kFilled);
  EXPECT_THAT(read.residuals_mm, IsEmpty());
}

TEST(C3dWriterTest, LosesNothingOfTheSample) {
  ARTICAP_NEEDS_TEST_DATA("c3d/Eb015pi.c3d");
  const MarkerRecording sample = *ReadMarkers(TestDataPath("c3d/Eb015pi.c3d"));
  const MarkerRecording read = ParseOrThrow(FormatMarkers(sample, MarkerFormat::kC3d));
  EXPECT_THAT(LossesOf(sample, MarkerFormat::kC3d), IsEmpty());
  ExpectSameSamples(read.tracks, sample.tracks, 0);
  EXPECT_EQ(read.camera_masks, sample.camera_masks);
  for (std::size_t i = 0; i < sample.residuals_mm.size(); ++i) {
    if (!std::isnan(sample.residuals_mm[i])) {
      ASSERT_EQ(read.residuals_mm[i], sample.residuals_mm[i]);
    }
  }
}

TEST(MarkerFormatOfTest, GoesByTheEnding) {
  EXPECT_EQ(*MarkerFormatOf("a/b.C3D"), MarkerFormat::kC3d);
  EXPECT_EQ(*MarkerFormatOf("take.nexus.csv"), MarkerFormat::kNexusCsv);
  EXPECT_EQ(*MarkerFormatOf("take_motive.csv"), MarkerFormat::kMotiveCsv);
  EXPECT_EQ(*MarkerFormatOf("take.csv"), MarkerFormat::kPlainCsv);
  EXPECT_THAT(MarkerFormatOf("take.xyz").error().message, HasSubstr(".c3d, .trc"));
}

TEST(ReadMarkersTest, NamesTheFileThatIsNotThere) {
  EXPECT_THAT(ReadMarkers("/nowhere/take.c3d").error().message, HasSubstr("/nowhere/take.c3d"));
}

// A cloud that spans 200 mm, in the numbers of `unit`, read as `named`.
std::optional<std::string> SizeComplaint(double numbers, const std::string& named) {
  MarkerRecording recording;
  recording.tracks = StageTracks({"a", "b", "c"}, 2, 100);
  const double mm = named == "m" ? 1000 : named == "cm" ? 10 : 1;
  for (int frame = 0; frame < 2; ++frame) {
    recording.tracks.Set(frame, 0, {0, 0, 0});
    recording.tracks.Set(frame, 1, {numbers * mm, 0, 0});
    recording.tracks.Set(frame, 2, {0, numbers * mm / 2, 0});
  }
  recording.source_unit = named;
  return ImplausibleSize(recording);
}

TEST(ImplausibleSizeTest, NamesTheUnitThatItLooksLike) {
  EXPECT_FALSE(SizeComplaint(200, "mm"));
  EXPECT_FALSE(SizeComplaint(20, "cm"));
  EXPECT_FALSE(SizeComplaint(45, "mm"));   // lips and jaw alone
  EXPECT_FALSE(SizeComplaint(450, "mm"));  // head, spectacles and collar
  EXPECT_THAT(*SizeComplaint(0.2, "mm"),
              HasSubstr("look like m: read the file with --force-unit m"));
  EXPECT_THAT(*SizeComplaint(20, "mm"),
              AnyOf(HasSubstr("look like cm"), HasSubstr("look like in")));
  EXPECT_THAT(*SizeComplaint(200, "m"), HasSubstr("look like mm"));
  EXPECT_THAT(*SizeComplaint(200, "cm"), HasSubstr("look like mm"));
  EXPECT_THAT(*SizeComplaint(0.2, ""), HasSubstr("--unit m"));
  EXPECT_THAT(*SizeComplaint(1100, "mm"), Not(HasSubstr("look like")));  // a whole body
}

TEST(DescribeRecordingTest, CountsWhatIsInIt) {
  MarkerRecording recording = SmallRecording();
  recording.tracks.SetMissing(0, 1);
  recording.tracks.SetMissing(3, 1);
  const StageReport report = DescribeRecording(recording, "small.c3d");
  EXPECT_THAT(report.verdict,
              HasSubstr("3 markers, 5 frames at 59.94 Hz (0.08 s), 3 of 15 samples missing"));
  ASSERT_FALSE(report.tables.empty());
  const ReportTable::Row& chin = report.tables[0].rows[1];
  EXPECT_EQ(chin.label, "chin");
  EXPECT_EQ(chin.values[0], 3);                      // missing
  EXPECT_EQ(chin.values[1], 2);                      // gaps
  EXPECT_EQ(chin.values[2], 2);                      // the longest
  EXPECT_EQ(report.tables[0].rows[2].values[3], 1);  // filled
  const std::string brief = report.BriefReport();
  EXPECT_THAT(brief, HasSubstr("begin (General) (Anna)"));
  EXPECT_THAT(brief, HasSubstr("audio [V]"));
}

}  // namespace
}  // namespace articap
