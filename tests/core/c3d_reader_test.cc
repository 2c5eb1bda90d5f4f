// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/marker_io.h"
#include "tests/core/c3d_builder.h"
#include "tests/core/marker_fixtures.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

struct Encoding {
  const char* name;
  C3dBuilder::Processor processor;
  bool is_float;
};

constexpr Encoding kEncodings[] = {{"IntelInt", C3dBuilder::Processor::kIntel, false},
                                   {"IntelFloat", C3dBuilder::Processor::kIntel, true},
                                   {"DecInt", C3dBuilder::Processor::kDec, false},
                                   {"DecFloat", C3dBuilder::Processor::kDec, true},
                                   {"MipsInt", C3dBuilder::Processor::kMips, false},
                                   {"MipsFloat", C3dBuilder::Processor::kMips, true}};

// Every case in every encoding.
class C3dEncodingTest : public testing::TestWithParam<Encoding> {
 protected:
  C3dEncodingTest() {
    builder.processor = GetParam().processor;
    builder.is_float = GetParam().is_float;
  }
  MarkerRecording Read() const { return ParseOrThrow(builder.Build()); }

  C3dBuilder builder;
};

INSTANTIATE_TEST_SUITE_P(All, C3dEncodingTest, testing::ValuesIn(kEncodings),
                         [](const auto& each) { return std::string(each.param.name); });

// What the builder's default samples must become.
void ExpectDefaultSamples(const MarkerRecording& recording, int num_frames) {
  ASSERT_EQ(recording.tracks.num_frames(), num_frames);
  for (int frame = 0; frame < num_frames; ++frame)
    for (int i = 0; i < recording.tracks.num_markers(); ++i) {
      const C3dBuilder::Point point = C3dBuilder::DefaultPoint(frame, i);
      ASSERT_EQ(recording.tracks.is_missing(frame, i), point.word < 0) << frame << " " << i;
      if (point.word < 0) continue;
      const Eigen::Vector3d expected(point.x, point.y, point.z);
      ASSERT_THAT(recording.tracks.position_mm(frame, i), PointNear(expected, 1e-9));
    }
}

TEST_P(C3dEncodingTest, ReadsPositionsResidualsAndCameras) {
  const MarkerRecording recording = Read();
  ExpectDefaultSamples(recording, 5);
  EXPECT_THAT(recording.tracks.names(), ElementsAre("A", "B", "C"));
  EXPECT_EQ(recording.tracks.rate_hz(), 100);
  EXPECT_EQ(recording.source_unit, "mm");
  EXPECT_FLOAT_EQ(recording.residuals_mm[0], 16 * 0.125F);
  EXPECT_EQ(recording.camera_masks[0], 5);
  EXPECT_TRUE(std::isnan(recording.residuals_mm[1 * 3 + 2]));
  EXPECT_EQ(recording.camera_masks[1 * 3 + 2], 0);
  EXPECT_FLOAT_EQ(recording.residual_step_mm, 0.125F);
  EXPECT_THAT(recording.warnings, IsEmpty());
}

TEST_P(C3dEncodingTest, ParametersAndDataMayLieElsewhere) {
  builder.parameter_block = 5;
  builder.blank_blocks_before_data = 3;
  ExpectDefaultSamples(Read(), 5);
}

TEST_P(C3dEncodingTest, DataStartOfTheParametersHelpsWhereTheHeaderHasNone) {
  builder.header_words[16] = 0;
  const MarkerRecording recording = Read();
  ExpectDefaultSamples(recording, 5);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("DATA_START"));
}

TEST_P(C3dEncodingTest, HeaderWinsOverAContradictingDataStart) {
  builder.SetNumbers("POINT", "DATA_START", 2, {2});
  const MarkerRecording recording = Read();
  ExpectDefaultSamples(recording, 5);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("the header was followed"));
}

TEST_P(C3dEncodingTest, UnitsMayBePaddedWithNulsOrSpelledOut) {
  for (const std::string& unit :
       {std::string("mm\0\0", 4), std::string("MM  "), std::string("millimetres")}) {
    builder.SetText("POINT", "UNITS", unit);
    EXPECT_EQ(Read().source_unit, "mm");
  }
}

TEST_P(C3dEncodingTest, OtherUnitsBecomeMillimetres) {
  builder.SetText("POINT", "UNITS", "m");
  const MarkerRecording recording = Read();
  EXPECT_THAT(recording.tracks.position_mm(0, 0), PointNear(Eigen::Vector3d(1e5, -5e4, 0), 1e-6));
  EXPECT_FLOAT_EQ(recording.residuals_mm[0], 2000);
}

TEST_P(C3dEncodingTest, UnknownUnitsAreAskedFor) {
  builder.Remove("POINT", "UNITS");
  EXPECT_THAT(FailureOf(builder.Build()), HasSubstr("--unit mm"));
  MarkerReadOptions options;
  options.unit = "cm";
  const MarkerRecording recording = ParseOrThrow(builder.Build(), "test", options);
  EXPECT_NEAR(recording.tracks.position_mm(0, 0).x(), 1000, 1e-9);
}

TEST_P(C3dEncodingTest, ManyLabelsContinueInFurtherParameters) {
  builder.num_points = 600;
  builder.num_frames = 1;
  std::vector<std::string> labels;
  for (int i = 0; i < 600; ++i) labels.push_back(std::to_string(i) + "M");
  builder.SetTexts("POINT", "LABELS", {labels.begin(), labels.begin() + 255});
  builder.SetTexts("POINT", "LABELS2", {labels.begin() + 255, labels.begin() + 510});
  builder.SetTexts("POINT", "LABELS3", {labels.begin() + 510, labels.end()});
  EXPECT_EQ(Read().tracks.names(), labels);
}

TEST_P(C3dEncodingTest, LongFilesCountTheirFramesInTrial) {
  builder.num_points = 1;
  builder.num_frames = 70001;
  builder.SetTexts("POINT", "LABELS", {"A"});
  builder.SetNumbers("TRIAL", "ACTUAL_START_FIELD", 2, {1, 0});
  builder.SetNumbers("TRIAL", "ACTUAL_END_FIELD", 2, {70001 - 65536, 1});
  const MarkerRecording recording = Read();
  EXPECT_EQ(recording.tracks.num_frames(), 70001);
  EXPECT_THAT(recording.warnings, IsEmpty());
  EXPECT_NEAR(recording.tracks.position_mm(4095, 0).y(), -50 + 0.125 * 4095, 1e-9);
}

TEST_P(C3dEncodingTest, LongFilesCountTheirFramesInPoint) {
  builder.num_points = 1;
  builder.num_frames = 66000;
  builder.SetTexts("POINT", "LABELS", {"A"});
  builder.SetNumbers("POINT", "FRAMES", 4, {66000});
  EXPECT_EQ(Read().tracks.num_frames(), 66000);
  builder.SetNumbers("POINT", "FRAMES", 2, {65535});
  builder.SetNumbers("POINT", "LONG_FRAMES", 4, {66000});
  EXPECT_EQ(Read().tracks.num_frames(), 66000);
}

TEST_P(C3dEncodingTest, CountsThatStopOrWrapAt65536AreExtendedByTheFilesSize) {
  builder.num_points = 1;
  builder.num_frames = 66000;
  builder.SetTexts("POINT", "LABELS", {"A"});
  MarkerRecording recording = Read();  // the builder's header stops at 65535
  EXPECT_GE(recording.tracks.num_frames(), 66000);
  EXPECT_LT(recording.tracks.num_frames(), 66000 + 512 / 8);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("too small a number"));
  builder.header_words[8] = 66000 - 65536;
  recording = Read();
  EXPECT_EQ(recording.tracks.num_frames(), 66000);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("too small a number"));
}

TEST_P(C3dEncodingTest, DuplicateLabelsAreRenamed) {
  builder.SetTexts("POINT", "LABELS", {"chin", "chin", "chin"});
  const MarkerRecording recording = Read();
  EXPECT_THAT(recording.tracks.names(), ElementsAre("chin", "chin_2", "chin_3"));
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("\"chin\" (marker 2) to \"chin_2\""));
}

TEST_P(C3dEncodingTest, SharedSubjectIsTakenOffTheNames) {
  builder.SetTexts("POINT", "LABELS", {"Anna:chin", "Anna:nose", "Anna:lip"});
  MarkerRecording recording = Read();
  EXPECT_EQ(recording.subject, "Anna");
  EXPECT_THAT(recording.tracks.names(), ElementsAre("chin", "nose", "lip"));
  builder.SetTexts("POINT", "LABELS", {"Anna:chin", "Bert:chin", "Anna:lip"});
  recording = Read();
  EXPECT_EQ(recording.subject, "");
  EXPECT_THAT(recording.tracks.names(), ElementsAre("Anna:chin", "Bert:chin", "Anna:lip"));
}

TEST_P(C3dEncodingTest, MissingLabelsAreNumbered) {
  builder.SetTexts("POINT", "LABELS", {"chin", "*1"});
  const MarkerRecording recording = Read();
  EXPECT_THAT(recording.tracks.names(), ElementsAre("chin", "unlabelled_2", "unlabelled_3"));
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("2 of 3 markers have no label"));
  builder.Remove("POINT", "LABELS");
  EXPECT_THAT(Read().tracks.names(), ElementsAre("unlabelled_1", "unlabelled_2", "unlabelled_3"));
}

TEST_P(C3dEncodingTest, FilesWithoutPointsAreReadable) {
  builder.num_points = 0;
  builder.num_frames = 0;
  builder.Remove("POINT", "LABELS").Remove("POINT", "UNITS");
  const MarkerRecording recording = Read();
  EXPECT_EQ(recording.tracks.num_markers(), 0);
  EXPECT_EQ(recording.tracks.num_frames(), 0);
}

TEST_P(C3dEncodingTest, FilesWithoutFramesAreReadable) {
  builder.num_frames = 0;
  EXPECT_EQ(Read().tracks.num_frames(), 0);
  EXPECT_EQ(Read().tracks.num_markers(), 3);
}

TEST_P(C3dEncodingTest, FirstFrameMayBeZeroOrLate) {
  for (const int first : {0, 705}) {
    builder.first_frame = first;
    const MarkerRecording recording = Read();
    EXPECT_EQ(recording.tracks.first_frame(), first);
    EXPECT_EQ(recording.tracks.num_frames(), 5);
    EXPECT_DOUBLE_EQ(SecondsOf(recording.tracks.start()), first == 0 ? 0 : 7.04);
  }
}

TEST_P(C3dEncodingTest, PromisedFramesThatAreNotThereAreCounted) {
  builder.num_frames = 400;
  const std::string whole = builder.Build();
  const std::size_t frame_bytes = 3 * 4 * (builder.is_float ? 4 : 2);
  const std::string cut = whole.substr(0, builder.DataOffset() + 200 * frame_bytes + 7);
  const MarkerRecording recording = ParseOrThrow(cut);
  ExpectDefaultSamples(recording, 200);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("should have 400 frames"));
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("holds 200; 200 are missing"));
}

TEST_P(C3dEncodingTest, FractionalRatesAreTheDecimalsThatWereMeant) {
  builder.rate_hz = 59.94F;
  builder.SetNumbers("POINT", "RATE", 4, {59.94});
  EXPECT_EQ(Read().tracks.rate_hz(), 59.94);
  builder.header_floats[20] = 59;  // some programs round here
  const MarkerRecording recording = Read();
  EXPECT_EQ(recording.tracks.rate_hz(), 59.94);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("POINT:RATE was followed"));
}

TEST_P(C3dEncodingTest, RatesOfZeroAreAskedFor) {
  for (const float rate_hz : {0.0F, -5.0F}) {
    builder.header_floats[20] = rate_hz;
    EXPECT_THAT(FailureOf(builder.Build()), HasSubstr("--rate-hz"));
  }
  MarkerReadOptions options;
  options.rate_hz = 120;
  EXPECT_EQ(ParseOrThrow(builder.Build(), "test", options).tracks.rate_hz(), 120);
  builder.header_floats[20] = 100;
  EXPECT_THAT(FailureOf(builder.Build(), "test", options), HasSubstr("leave --rate-hz out"));
}

TEST_P(C3dEncodingTest, GeneratedSamplesAreMarkedFilled) {
  builder.point = [](int frame, int i) {
    C3dBuilder::Point point = C3dBuilder::DefaultPoint(frame, i);
    if (frame == 2) point.word = 0;
    return point;
  };
  const MarkerRecording recording = Read();
  EXPECT_EQ(recording.tracks.state(2, 0), SampleState::kFilled);
  EXPECT_EQ(recording.tracks.state(3, 0), SampleState::kMeasured);
  EXPECT_EQ(recording.residuals_mm[2 * 3], 0);
}

TEST_P(C3dEncodingTest, WithoutAnyResidualAllSamplesAreMeasured) {
  builder.point = [](int frame, int i) {
    C3dBuilder::Point point = C3dBuilder::DefaultPoint(frame, i);
    if (point.word > 0) point.word = 0;
    return point;
  };
  const MarkerRecording recording = Read();
  EXPECT_EQ(recording.tracks.state(2, 0), SampleState::kMeasured);
  EXPECT_THAT(recording.residuals_mm, IsEmpty());
  EXPECT_THAT(recording.camera_masks, IsEmpty());
}

TEST_P(C3dEncodingTest, ZerosWithoutResidualAreMissing) {
  builder.point = [](int frame, int i) {
    return frame == 1 && i == 0 ? C3dBuilder::Point{} : C3dBuilder::DefaultPoint(frame, i);
  };
  EXPECT_TRUE(Read().tracks.is_missing(1, 0));
  EXPECT_THAT(Joined(Read().warnings), HasSubstr("1 samples are 0 0 0"));
  MarkerReadOptions options;
  options.zero_is_missing = false;
  EXPECT_FALSE(ParseOrThrow(builder.Build(), "test", options).tracks.is_missing(1, 0));
}

TEST_P(C3dEncodingTest, AnalogChannelsAreScaled) {
  builder.num_channels = 2;
  builder.samples_per_frame = 3;
  builder.SetNumbers("ANALOG", "GEN_SCALE", 4, {0.5});
  builder.SetNumbers("ANALOG", "SCALE", 4, {2, 4});
  builder.SetNumbers("ANALOG", "OFFSET", 2, {0, 100});
  builder.SetTexts("ANALOG", "LABELS", {"audio", "foot"});
  builder.SetTexts("ANALOG", "UNITS", {"V", "N"});
  builder.SetTexts("ANALOG", "DESCRIPTIONS", {"sync", ""});
  const MarkerRecording recording = Read();
  ExpectDefaultSamples(recording, 5);
  ASSERT_THAT(recording.analog.channels, SizeIs(2));
  EXPECT_EQ(recording.analog.samples_per_frame, 3);
  EXPECT_EQ(recording.analog.channels[0].name, "audio");
  EXPECT_EQ(recording.analog.channels[0].description, "sync");
  EXPECT_EQ(recording.analog.channels[1].unit, "N");
  ASSERT_THAT(recording.analog.channels[1].samples, SizeIs(15));
  for (int k = 0; k < 15; ++k) {
    EXPECT_DOUBLE_EQ(recording.analog.channels[0].samples[k], 10 * k);
    EXPECT_DOUBLE_EQ(recording.analog.channels[1].samples[k], (10 * k + 1 - 100) * 2);
  }
}

TEST_P(C3dEncodingTest, AnalogMayBeUnsigned) {
  if (builder.is_float) GTEST_SKIP() << "floats have a sign of their own";
  builder.num_channels = 1;
  builder.samples_per_frame = 1;
  builder.analog = [](int, int) { return 40000; };
  builder.SetNumbers("ANALOG", "SCALE", 4, {1});
  EXPECT_EQ(Read().analog.channels[0].samples[0], 40000 - 65536);
  builder.SetText("ANALOG", "FORMAT", "UNSIGNED");
  builder.SetNumbers("ANALOG", "OFFSET", 2, {32768});
  EXPECT_EQ(Read().analog.channels[0].samples[0], 40000 - 32768);
}

TEST_P(C3dEncodingTest, EventsOfTheGroupAreRead) {
  builder.SetNumbers("EVENT", "USED", 2, {2});
  builder.SetNumbers("EVENT", "TIMES", 4, {0, 1.5, 1, 2.25}, {2, 2});
  builder.SetTexts("EVENT", "LABELS", {"begin", "end"});
  builder.SetTexts("EVENT", "CONTEXTS", {"General", "Left"});
  builder.SetTexts("EVENT", "SUBJECTS", {"Anna", ""});
  const MarkerRecording recording = Read();
  ASSERT_THAT(recording.events, SizeIs(2));
  EXPECT_EQ(recording.events[0].label, "begin");
  EXPECT_EQ(recording.events[0].subject, "Anna");
  EXPECT_EQ(recording.events[1].context, "Left");
  EXPECT_DOUBLE_EQ(recording.events[1].time_s, 62.25);
}

TEST_P(C3dEncodingTest, EventsOfTheHeaderAreReadWhereThereIsNoGroup) {
  builder.header_words[298] = 12345;
  builder.header_words[300] = 2;
  builder.header_floats[304] = 1.25;
  builder.header_floats[308] = 2.5;
  builder.header_texts[396] = "RIC LTO ";
  const MarkerRecording recording = Read();
  ASSERT_THAT(recording.events, SizeIs(2));
  EXPECT_EQ(recording.events[0].label, "RIC");
  EXPECT_EQ(recording.events[1].time_s, 2.5);
}

TEST_P(C3dEncodingTest, DescriptionsAreKept) {
  builder.SetTexts("POINT", "DESCRIPTIONS", {"first", "", "third"});
  EXPECT_THAT(Read().descriptions, ElementsAre("first", "", "third"));
}

TEST_P(C3dEncodingTest, ModelOutputsAreNotMarkers) {
  builder.SetTexts("POINT", "ANGLES", {"B"});
  const MarkerRecording recording = Read();
  EXPECT_THAT(recording.tracks.names(), ElementsAre("A", "C"));
  EXPECT_NEAR(recording.tracks.position_mm(0, 1).x(), 120, 1e-9);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("model outputs"));
}

TEST_P(C3dEncodingTest, GroupsThatAreNotKeptAreNamed) {
  builder.SetNumbers("FORCE_PLATFORM", "USED", 2, {1});
  EXPECT_THAT(Joined(Read().warnings), HasSubstr("FORCE_PLATFORM"));
}

TEST_P(C3dEncodingTest, DamagedParametersLeaveTheRestReadable) {
  builder.SetNumbers("POINT", "DATA_START", 2,
                     {static_cast<double>(1 + static_cast<int>(builder.DataOffset() / 512))});
  std::string bytes = builder.Build();
  // The type of the second parameter, LABELS, becomes nonsense.
  const std::size_t at = bytes.find("LABELS") + 6 + 2;
  bytes[at] = 77;
  const MarkerRecording recording = ParseOrThrow(bytes);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("parameter section is damaged at byte"));
  ExpectDefaultSamples(recording, 5);
  EXPECT_THAT(recording.tracks.names(), Contains("unlabelled_1"));
}

TEST_P(C3dEncodingTest, DisagreeingFrameCountsAreSettledByTheSize) {
  builder.num_frames = 200;
  builder.header_words[8] = 150;
  builder.SetNumbers("TRIAL", "ACTUAL_START_FIELD", 2, {1, 0});
  builder.SetNumbers("TRIAL", "ACTUAL_END_FIELD", 2, {200, 0});
  const MarkerRecording recording = Read();
  EXPECT_EQ(recording.tracks.num_frames(), 200);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("The header promises 150 frames"));
}

TEST(C3dFloatTest, NonFiniteCoordinatesAreMissing) {
  for (const auto processor : {C3dBuilder::Processor::kIntel, C3dBuilder::Processor::kMips}) {
    C3dBuilder builder;
    builder.processor = processor;
    builder.point = [](int frame, int i) {
      C3dBuilder::Point point = C3dBuilder::DefaultPoint(frame, i);
      if (frame == 0 && i == 0) point.x = std::numeric_limits<double>::quiet_NaN();
      if (frame == 3 && i == 1) point.z = std::numeric_limits<double>::infinity();
      return point;
    };
    const MarkerRecording recording = ParseOrThrow(builder.Build());
    EXPECT_TRUE(recording.tracks.is_missing(0, 0));
    EXPECT_TRUE(recording.tracks.is_missing(3, 1));
    EXPECT_FALSE(recording.tracks.is_missing(3, 0));
    EXPECT_THAT(Joined(recording.warnings), HasSubstr("2 samples are not finite"));
  }
}

TEST(C3dFloatTest, StatusWordsAreCastToIntegersFirst) {
  C3dBuilder builder;
  builder.point = [](int frame, int i) {
    C3dBuilder::Point point = C3dBuilder::DefaultPoint(0, i);
    point.word = frame == 0 ? 62 * 256 + 16.9 : frame == 1 ? 1e30 : frame == 2 ? -1 : 300;
    return point;
  };
  const MarkerRecording recording = ParseOrThrow(builder.Build());
  EXPECT_EQ(recording.camera_masks[0], 62);
  EXPECT_FLOAT_EQ(recording.residuals_mm[0], 2);
  EXPECT_EQ(recording.tracks.state(1, 0), SampleState::kFilled);
  EXPECT_TRUE(recording.tracks.is_missing(2, 0));
  EXPECT_EQ(recording.camera_masks[3 * 3], 1);
}

TEST(C3dReaderTest, ScaleOfZeroIsRefused) {
  C3dBuilder builder;
  builder.scale = 0;
  EXPECT_THAT(FailureOf(builder.Build()), HasSubstr("scale factor"));
}

// c3d.org's sample01 in its six encodings.
class C3dSampleTest : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(All, C3dSampleTest, testing::Values("pi", "pr", "vi", "vr", "si", "sr"),
                         [](const auto& each) { return std::string(each.param); });

MarkerRecording ReadSample(const std::string& encoding) {
  auto recording = ReadMarkers(TestDataPath("c3d/Eb015" + encoding + ".c3d"));
  if (!recording) throw std::runtime_error(recording.error().message);
  return std::move(*recording);
}

TEST_P(C3dSampleTest, HoldsWhatIsPublished) {
  ARTICAP_NEEDS_TEST_DATA("c3d/Eb015pi.c3d");
  const MarkerRecording recording = ReadSample(GetParam());
  const StageTracks& tracks = recording.tracks;
  EXPECT_EQ(tracks.num_markers(), 26);
  EXPECT_EQ(tracks.num_frames(), 450);
  EXPECT_EQ(tracks.rate_hz(), 50);
  EXPECT_THAT(tracks.position_mm(0, 0), PointNear(Eigen::Vector3d(248.583, 226.833, 37.417), 1e-3));
  EXPECT_NEAR(recording.residuals_mm[0], 1.3333, 1e-4);
  EXPECT_EQ(recording.camera_masks[0], 62);
  int missing = 0;
  for (int marker = 0; marker < 26; ++marker) missing += tracks.CountMissing(marker);
  EXPECT_EQ(26 * 450 - missing, 11474);
  EXPECT_EQ(tracks.names()[0], "RFT1");
  EXPECT_THAT(recording.analog.channels, SizeIs(16));
  EXPECT_EQ(recording.analog.samples_per_frame, 4);
  ASSERT_THAT(recording.events, SizeIs(3));
  EXPECT_EQ(recording.events[1].label, "RHS");
  EXPECT_EQ(recording.events[1].time_s, 5.4);
}

TEST_P(C3dSampleTest, AgreesWithTheOtherEncodings) {
  ARTICAP_NEEDS_TEST_DATA("c3d/Eb015pi.c3d");
  const MarkerRecording reference = ReadSample("pr");
  const MarkerRecording recording = ReadSample(GetParam());
  double worst_mm = 0;
  for (int frame = 0; frame < 450; ++frame)
    for (int marker = 0; marker < 26; ++marker) {
      ASSERT_EQ(recording.tracks.state(frame, marker), reference.tracks.state(frame, marker));
      if (recording.tracks.is_missing(frame, marker)) continue;
      const Eigen::Vector3d difference =
          recording.tracks.position_mm(frame, marker) - reference.tracks.position_mm(frame, marker);
      worst_mm = std::max(worst_mm, difference.cwiseAbs().maxCoeff());
    }
  EXPECT_LT(worst_mm, 1e-4);
  for (std::size_t i = 0; i < reference.residuals_mm.size(); ++i)
    if (!std::isnan(reference.residuals_mm[i])) {
      ASSERT_NEAR(recording.residuals_mm[i], reference.residuals_mm[i], 1e-4);
    }
  EXPECT_EQ(recording.camera_masks, reference.camera_masks);
  for (int channel = 0; channel < 16; ++channel)
    for (std::size_t k = 0; k < reference.analog.channels[channel].samples.size(); ++k)
      ASSERT_NEAR(recording.analog.channels[channel].samples[k],
                  reference.analog.channels[channel].samples[k], 1e-3);
}

}  // namespace
}  // namespace articap
