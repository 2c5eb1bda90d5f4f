// SPDX-License-Identifier: MIT
// TRC, Qualisys TSV and the CSV layouts as other programs write them, well and badly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "core/marker_io.h"
#include "tests/core/marker_fixtures.h"
#include "tests/support/matchers.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::string Replace(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

constexpr char kTrc[] =
    "PathFileType\t4\t(X/Y/Z)\tjaw.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
    "OrigNumFrames\n"
    "50.00\t50.00\t3\t2\tmm\t50.00\t1\t3\n"
    "Frame#\tTime\tchin\t\t\tnose\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "1\t0.00\t1.5\t2\t-3\t10\t20\t30\n"
    "2\t0.02\t\t\t\t11\t21\t31\n"
    "3\t0.04\t1.75\t2e1\t-3.5\t12\t22\t32\n";

void ExpectTrcSamples(const MarkerRecording& recording, double mm_per_unit = 1) {
  const StageTracks& tracks = recording.tracks;
  ASSERT_EQ(tracks.num_frames(), 3);
  ASSERT_THAT(tracks.names(), ElementsAre("chin", "nose"));
  EXPECT_EQ(tracks.rate_hz(), 50);
  EXPECT_TRUE(tracks.is_missing(1, 0));
  EXPECT_THAT(tracks.position_mm(2, 0),
              PointNear(mm_per_unit * Eigen::Vector3d(1.75, 20, -3.5), 1e-9));
  EXPECT_THAT(tracks.position_mm(1, 1), PointNear(mm_per_unit * Eigen::Vector3d(11, 21, 31), 1e-9));
}

TEST(TrcTest, ReadsSamplesAndMissingOnes) {
  const MarkerRecording recording = ParseOrThrow(kTrc);
  ExpectTrcSamples(recording);
  EXPECT_THAT(recording.warnings, IsEmpty());
}

TEST(TrcTest, ToleratesWhatEditorsDoToText) {
  const std::string trc = kTrc;
  ExpectTrcSamples(ParseOrThrow(Replace(trc, "\n", "\r\n")));
  ExpectTrcSamples(ParseOrThrow(Replace(trc, "\n", "\r")));
  ExpectTrcSamples(ParseOrThrow("\xef\xbb\xbf" + trc));
  ExpectTrcSamples(ParseOrThrow(Replace(trc, "\t", ",")));
  ExpectTrcSamples(ParseOrThrow(trc.substr(0, trc.size() - 1)));
  ExpectTrcSamples(ParseOrThrow(Replace(trc, "Z2\n\n", "Z2\n")));
  ExpectTrcSamples(ParseOrThrow(Replace(trc, "\tmm\t50.00\t1\t3", "\tmm")));
  ExpectTrcSamples(ParseOrThrow(trc + "\n\n"));
}

TEST(TrcTest, ConvertsUnits) {
  ExpectTrcSamples(ParseOrThrow(Replace(kTrc, "\tmm\t", "\tm\t")), 1000);
  ExpectTrcSamples(ParseOrThrow(Replace(kTrc, "\tmm\t", "\tcm\t")), 10);
  ExpectTrcSamples(ParseOrThrow(Replace(kTrc, "\tmm\t", "\tinches\t")), 25.4);
}

TEST(TrcTest, RowsCutAnywhereLoseOnlyThemselves) {
  const std::string trc = kTrc;
  for (std::size_t cut = 2; cut < 20; ++cut) {
    const MarkerRecording recording = ParseOrThrow(trc.substr(0, trc.size() - cut));
    // A last cell that lost digits is still a cell; anything less is no row.
    if (recording.tracks.num_frames() == 3) continue;
    EXPECT_EQ(recording.tracks.num_frames(), 2) << cut;
    EXPECT_THAT(Joined(recording.warnings), HasSubstr("The last row was cut short"));
    EXPECT_THAT(Joined(recording.warnings), HasSubstr("promises 3 frames, the file has 2"));
  }
}

TEST(TrcTest, CutHeadersAreRefused) {
  const std::string trc = kTrc;
  EXPECT_THAT(FailureOf(trc.substr(0, trc.find("Frame#")), "a.trc"), HasSubstr("cut short"));
  EXPECT_THAT(FailureOf("", "a.trc"), HasSubstr("empty"));
  EXPECT_THAT(FailureOf(" \n\n", "a.trc"), HasSubstr("empty"));
}

TEST(TrcTest, MissingMayBeSaidInManyWays) {
  for (const std::string& missing :
       {std::string("nan\tNaN\tNAN"), std::string("0\t0\t0"), std::string("0.000\t-0.0\t0"),
        std::string("inf\t1\t2"), std::string("1.#QNAN\t1.#QNAN\t1.#QNAN"), std::string("\t5\t"),
        std::string("-nan(ind)\t-nan(ind)\t-nan(ind)"), std::string("NA\tNA\tNA"),
        std::string("1e999\t0\t1")}) {
    const MarkerRecording recording =
        ParseOrThrow(Replace(kTrc, "2\t0.02\t\t\t\t", "2\t0.02\t" + missing + "\t"));
    ExpectTrcSamples(recording);
    EXPECT_THAT(recording.warnings, SizeIs(testing::Ge(1U))) << missing;
  }
}

TEST(TrcTest, TheOriginMayBeAPlace) {
  const std::string trc = Replace(kTrc, "2\t0.02\t\t\t\t", "2\t0.02\t0\t0\t0\t");
  MarkerReadOptions options;
  options.zero_is_missing = false;
  const MarkerRecording recording = ParseOrThrow(trc, "test", options);
  EXPECT_FALSE(recording.tracks.is_missing(1, 0));
  EXPECT_THAT(recording.warnings, IsEmpty());
}

TEST(TrcTest, WordsInCellsAreRefusedWithTheirPlace) {
  const std::string message = FailureOf(Replace(kTrc, "\t21\t", "\t2l\t"), "jaw.trc");
  EXPECT_THAT(message, HasSubstr("jaw.trc, line 8, column 7 (marker nose): \"2l\""));
}

TEST(TrcTest, UnitsAreNeverGuessed) {
  const std::string without = Replace(kTrc, "\tmm\t", "\t\t");
  EXPECT_THAT(FailureOf(without), HasSubstr("--unit mm"));
  MarkerReadOptions options;
  options.unit = "cm";
  ExpectTrcSamples(ParseOrThrow(without, "test", options), 10);
  EXPECT_THAT(FailureOf(kTrc, "test", options), HasSubstr("the file says its unit is mm"));
  options.unit = "parsec";
  EXPECT_THAT(FailureOf(without, "test", options), HasSubstr("parsec"));
  EXPECT_THAT(FailureOf(Replace(kTrc, "\tmm\t", "\tpx\t")), HasSubstr("\"px\" is not a unit"));
  options = {};
  options.force_unit = "m";
  const MarkerRecording forced = ParseOrThrow(kTrc, "test", options);
  ExpectTrcSamples(forced, 1000);
  EXPECT_THAT(Joined(forced.warnings), HasSubstr("was overruled"));
}

TEST(TrcTest, TimesWinOverAWrongRate) {
  const std::string precise = Replace(Replace(kTrc, "0.02", "0.0200"), "0.04", "0.0400");
  const MarkerRecording recording = ParseOrThrow(Replace(precise, "50.00\t50.00\t3", "60\t60\t3"));
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings),
              HasSubstr("The header says 60 frames a second, the time column 50"));
  for (const std::string& rate : {std::string("0"), std::string("-50"), std::string("nan")}) {
    const MarkerRecording repaired =
        ParseOrThrow(Replace(kTrc, "50.00\t50.00\t3", rate + "\t" + rate + "\t3"));
    ExpectTrcSamples(repaired);
    EXPECT_THAT(Joined(repaired.warnings), HasSubstr("the time column was followed")) << rate;
  }
}

TEST(TrcTest, TheRateWinsOverUselessTimes) {
  const std::string still = Replace(Replace(kTrc, "\t0.02\t", "\t0.00\t"), "\t0.04\t", "\t0.00\t");
  const MarkerRecording recording = ParseOrThrow(still);
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("The times do not increase"));
  const std::string without_rate = Replace(still, "50.00\t50.00\t3", "0\t0\t3");
  EXPECT_THAT(FailureOf(without_rate), HasSubstr("--rate-hz"));
  MarkerReadOptions options;
  options.rate_hz = 50;
  ExpectTrcSamples(ParseOrThrow(without_rate, "test", options));
  options.rate_hz = 25;
  EXPECT_THAT(FailureOf(kTrc, "test", options), HasSubstr("leave --rate-hz out"));
}

TEST(TrcTest, FramesLeftOutBecomeMissingSamples) {
  const MarkerRecording recording = ParseOrThrow(Replace(kTrc, "3\t0.04\t", "6\t0.10\t"));
  EXPECT_EQ(recording.tracks.num_frames(), 6);
  EXPECT_TRUE(recording.tracks.is_missing(3, 1));
  EXPECT_EQ(recording.tracks.position_mm(5, 1).x(), 12);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("leaves out 3 of 6 frames"));
  EXPECT_THAT(FailureOf(Replace(kTrc, "3\t0.04\t", "1000000000\t20000000.00\t")),
              HasSubstr("the frames jump by"));
}

TEST(TrcTest, StartComesFromTheTimeColumn) {
  std::string late = Replace(Replace(kTrc, "1\t0.00", "1\t7.50"), "2\t0.02", "2\t7.52");
  late = Replace(late, "3\t0.04", "3\t7.54");
  EXPECT_DOUBLE_EQ(SecondsOf(ParseOrThrow(late).tracks.start()), 7.5);
}

TEST(TrcTest, HeadersThatMiscountAreSettledByTheColumns) {
  MarkerRecording recording = ParseOrThrow(Replace(kTrc, "\t3\t2\tmm", "\t9\t7\tmm"));
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("promises 7 markers, the columns are of 2"));
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("promises 9 frames, the file has 3"));
  recording = ParseOrThrow(Replace(kTrc, "chin\t\t\tnose\t\t\n", "chin\tnose\n"));
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("taken in order"));
  recording = ParseOrThrow(Replace(kTrc, "chin\t\t\tnose\t\t\n", "chin\n"));
  EXPECT_THAT(recording.tracks.names(), ElementsAre("chin", "unlabelled_2"));
}

TEST(TrcTest, ShortRowsMissTheirLastMarkers) {
  const MarkerRecording recording = ParseOrThrow(Replace(kTrc, "\t11\t21\t31\n", "\n"));
  EXPECT_TRUE(recording.tracks.is_missing(1, 1));
  EXPECT_FALSE(recording.tracks.is_missing(2, 1));
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("1 rows have fewer cells"));
}

TEST(TrcTest, RealRecordingsAreWhole) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const auto jaw = ReadMarkers(TestDataPath("animface/jaw.trc"));
  ASSERT_TRUE(jaw) << jaw.error().message;
  EXPECT_EQ(jaw->tracks.num_markers(), 41);
  EXPECT_EQ(jaw->tracks.num_frames(), 1590);
  EXPECT_EQ(jaw->tracks.rate_hz(), 60);
  EXPECT_EQ(jaw->tracks.names()[10], "NoseTop");
  EXPECT_THAT(jaw->warnings, IsEmpty());
  EXPECT_FALSE(ImplausibleSize(*jaw));
  const auto cheeks = ReadMarkers(TestDataPath("animface/cheeks.trc"));
  ASSERT_TRUE(cheeks) << cheeks.error().message;
  EXPECT_EQ(cheeks->tracks.names(), jaw->tracks.names());
  EXPECT_EQ(cheeks->tracks.num_frames(), 1499);
  const auto speech = ReadMarkers(TestDataPath("speech/F01_B01_S01_R01_N.trc"));
  ASSERT_TRUE(speech) << speech.error().message;
  EXPECT_THAT(speech->tracks.names(),
              ElementsAre("TR", "TB", "TT", "UL", "LL", "ML", "JAW", "JAWL"));
  EXPECT_THAT(speech->tracks.position_mm(0, 0),
              PointNear(Eigen::Vector3d(-45.7246, -2.3115, -5.7338), 1e-9));
  EXPECT_FALSE(ImplausibleSize(*speech));
}

constexpr char kTsv[] =
    "NO_OF_FRAMES\t3\nNO_OF_CAMERAS\t6\nNO_OF_MARKERS\t2\nFREQUENCY\t50\nNO_OF_ANALOG\t0\n"
    "ANALOG_FREQUENCY\t0\nDESCRIPTION\t--\nTIME_STAMP\t2024-03-01, 10:11:12.000\t123.5\n"
    "DATA_INCLUDED\t3D\nEVENT\tbegin\t2\t0.02\nMARKER_NAMES\tchin\tnose\t\n"
    "TRAJECTORY_TYPES\tMeasured\tMixed\n";

TEST(QualisysTsvTest, ReadsRowsWithAndWithoutLeadingColumns) {
  const std::string bare =
      "1.5\t2\t-3\t10\t20\t30\n0.000\t0.000\t0.000\t11\t21\t31\n1.75\t20\t-3.5\t12\t22\t32\n";
  const std::string full =
      "Frame\tTime\tchin X\tchin Y\tchin Z\tnose X\tnose Y\tnose Z\n"
      "1\t0.00000\t1.5\t2\t-3\t10\t20\t30\n2\t0.02000\t\t\t\t11\t21\t31\n"
      "3\t0.04000\t1.75\t20\t-3.5\t12\t22\t32\n";
  const std::string unnamed = full.substr(full.find('\n') + 1);
  for (const std::string& rows : {bare, full, unnamed, Replace(bare, "\n", "\t\n")}) {
    const MarkerRecording recording = ParseOrThrow(kTsv + rows);
    ExpectTrcSamples(recording);
    EXPECT_EQ(recording.source_unit, "mm");
    ASSERT_THAT(recording.events, SizeIs(1));
    EXPECT_EQ(recording.events[0].label, "begin");
    EXPECT_DOUBLE_EQ(recording.events[0].time_s, 0.02);
  }
}

TEST(QualisysTsvTest, TheUnitIsTheFormatsUnlessTheOptionSaysOtherwise) {
  const std::string tsv = std::string(kTsv) + "1.5\t2\t-3\t10\t20\t30\n";
  MarkerReadOptions options;
  options.unit = "m";
  EXPECT_NEAR(ParseOrThrow(tsv, "test", options).tracks.position_mm(0, 0).x(), 1500, 1e-9);
}

TEST(QualisysTsvTest, OtherDataAreRefused) {
  EXPECT_THAT(FailureOf(Replace(kTsv, "DATA_INCLUDED\t3D", "DATA_INCLUDED\t6D")),
              HasSubstr("holds 6D data"));
}

TEST(QualisysTsvTest, ExternalTimebaseNeedsARate) {
  const std::string tsv = Replace(kTsv, "FREQUENCY\t50", "FREQUENCY\tEXT") +
                          "1.5\t2\t-3\t10\t20\t30\n1.5\t2\t-3\t10\t20\t30\n";
  EXPECT_THAT(FailureOf(tsv), HasSubstr("--rate-hz"));
}

constexpr char kNexus[] =
    "Trajectories\n50\n,,Anna:chin,,,Anna:nose,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n"
    ",,mm,mm,mm,mm,mm,mm\n"
    "1,0,1.5,2,-3,10,20,30\n2,0,,,,11,21,31\n3,0,1.75,20,-3.5,12,22,32\n";

TEST(NexusCsvTest, ReadsTrajectories) {
  const MarkerRecording recording = ParseOrThrow(kNexus);
  ExpectTrcSamples(recording);
  EXPECT_EQ(recording.subject, "Anna");
  EXPECT_THAT(recording.warnings, IsEmpty());
}

TEST(NexusCsvTest, FindsTheSectionAmongOthers) {
  const std::string devices = "Devices\n1000\n,,Force\nFrame,Sub Frame,Fx\n,,N\n1,0,2\n1,1,3\n\n";
  const MarkerRecording recording =
      ParseOrThrow(devices + kNexus + "\nModel Outputs\n50\n,,Angle\n");
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("The section \"Devices\" was left out"));
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("behind a blank line was left out"));
}

TEST(NexusCsvTest, LeavesDerivativesOut) {
  std::string text = Replace(kNexus, "X,Y,Z,X,Y,Z\n", "X,Y,Z,X,Y,Z,X',Y',Z'\n");
  text = Replace(text, "30\n", "30,7,8,9\n");
  const MarkerRecording recording = ParseOrThrow(text);
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("3 columns are no positions"));
}

TEST(NexusCsvTest, RefusesMixedUnitsAndMissingHeaders) {
  EXPECT_THAT(FailureOf(Replace(kNexus, ",,mm,mm,mm,mm,mm,mm", ",,mm,mm,mm,m,m,m")),
              HasSubstr("several units"));
  EXPECT_THAT(FailureOf(Replace(kNexus, ",,mm,mm,mm,mm,mm,mm", ",,,,,,,")), HasSubstr("--unit mm"));
  EXPECT_THAT(FailureOf("Trajectories\n50\n"), HasSubstr("should go on with its rate"));
}

constexpr char kMotive[] =
    "Format Version,1.23,Take Name,Take 1,Capture Frame Rate,50.000000,Export Frame Rate,50.000000,"
    "Total Frames in Take,3,Total Exported Frames,3,Rotation Type,Quaternion,Length Units,Meters,"
    "Coordinate Space,Global\n\n"
    ",Type,Rigid Body,Rigid Body,Rigid Body,Marker,Marker,Marker,Marker,Marker,Marker\n"
    ",Name,Head,Head,Head,chin,chin,chin,nose,nose,nose\n"
    ",ID,1,1,1,2,2,2,3,3,3\n"
    ",,Rotation,Rotation,Rotation,Position,Position,Position,Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,X,Y,Z,X,Y,Z\n"
    "0,0.000000,1,2,3,0.0015,0.002,-0.003,0.010,0.020,0.030\n"
    "1,0.020000,1,2,3,,,,0.011,0.021,0.031\n"
    "2,0.040000,1,2,3,0.00175,0.020,-0.0035,0.012,0.022,0.032\n";

TEST(MotiveCsvTest, ReadsMarkersInMetres) {
  const MarkerRecording recording = ParseOrThrow(kMotive);
  ExpectTrcSamples(recording);
  EXPECT_EQ(recording.source_unit, "m");
  EXPECT_EQ(recording.tracks.first_frame(), 0);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("3 columns (rigid bodies"));
}

TEST(MotiveCsvTest, PrefersReconstructedMarkersToSolvedOnes) {
  std::string text = Replace(kMotive, "Type,Rigid Body,Rigid Body,Rigid Body",
                             "Type,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker");
  text = Replace(text, "Rotation,Rotation,Rotation", "Position,Position,Position");
  EXPECT_THAT(ParseOrThrow(text).tracks.names(), ElementsAre("chin", "nose", "Head"));
  text = Replace(text, "Name,Head,Head,Head", "Name,chin,chin,chin");
  ExpectTrcSamples(ParseOrThrow(text));
}

constexpr char kPlain[] =
    "frame,time_s,chin_x_mm,chin_y_mm,chin_z_mm,nose_x_mm,nose_y_mm,nose_z_mm\n"
    "1,0.00,1.5,2,-3,10,20,30\n2,0.02,,,,11,21,31\n3,0.04,1.75,20,-3.5,12,22,32\n";

TEST(PlainCsvTest, ReadsManySpellingsOfItsColumns) {
  const MarkerRecording recording = ParseOrThrow(kPlain);
  ExpectTrcSamples(recording);
  EXPECT_THAT(recording.warnings, IsEmpty());
  ExpectTrcSamples(ParseOrThrow(Replace(kPlain, "_mm", " (mm)")));
  ExpectTrcSamples(ParseOrThrow(Replace(kPlain, "_mm", "[mm]")));
  ExpectTrcSamples(ParseOrThrow(Replace(kPlain, "_mm", "_cm")), 10);
  ExpectTrcSamples(ParseOrThrow(Replace(kPlain, ",", ";")));
  ExpectTrcSamples(ParseOrThrow(Replace(Replace(kPlain, ",", ";"), ".", ",")));
  ExpectTrcSamples(ParseOrThrow(Replace(kPlain, ",", "\t")));
  ExpectTrcSamples(ParseOrThrow(Replace(kPlain, "frame,time_s", "Frame#,Time")));
  MarkerReadOptions options;
  options.unit = "mm";
  for (const char* separator : {"_", ".", " ", ":"}) {
    std::string text = Replace(kPlain, "_mm", "");
    for (const char* axis : {"x", "y", "z"})
      text = Replace(text, std::string("_") + axis, std::string(separator) + char(axis[0] - 32));
    ExpectTrcSamples(ParseOrThrow(text, "a.csv", options));
  }
}

TEST(PlainCsvTest, TimeMayBeInMilliseconds) {
  std::string text = Replace(kPlain, "time_s", "time_ms");
  text = Replace(Replace(text, "2,0.02,", "2,20,"), "3,0.04,", "3,40,");
  ExpectTrcSamples(ParseOrThrow(text));
}

TEST(PlainCsvTest, NeedsUnitAndRate) {
  EXPECT_THAT(FailureOf(Replace(kPlain, "_mm", "")), HasSubstr("--unit mm"));
  EXPECT_THAT(FailureOf(Replace(kPlain, "nose_x_mm", "nose_x_m")), HasSubstr("several units"));
  const std::string timeless = Replace(kPlain, "time_s", "note");
  EXPECT_THAT(FailureOf(timeless), HasSubstr("--rate-hz"));
  MarkerReadOptions options;
  options.rate_hz = 50;
  const MarkerRecording recording = ParseOrThrow(timeless, "test", options);
  ExpectTrcSamples(recording);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("1 columns are no coordinates"));
}

TEST(PlainCsvTest, IncompleteMarkersAndOtherTextsAreRefused) {
  EXPECT_THAT(FailureOf(Replace(kPlain, "nose_z_mm", "nose_w_mm")),
              HasSubstr("marker nose has no z column"));
  EXPECT_THAT(FailureOf("hello\nworld\n"), HasSubstr("none of the marker formats"));
  EXPECT_THAT(FailureOf("hello\nworld\n", "a.c3d"), HasSubstr("not a C3D file"));
  EXPECT_THAT(FailureOf(std::string("\xff\xfeh\0e\0", 6)), HasSubstr("UTF-16"));
}

TEST(PlainCsvTest, RateFollowsFromTimesWithFewDigits) {
  std::ostringstream text;
  text << "time,a_x_mm,a_y_mm,a_z_mm\n";
  text.precision(3);
  text << std::fixed;
  for (int frame = 0; frame < 600; ++frame) text << frame / 120.0 << ",1,2,3\n";
  const MarkerRecording recording = ParseOrThrow(text.str());
  EXPECT_EQ(recording.tracks.rate_hz(), 120);
  EXPECT_EQ(recording.tracks.num_frames(), 600);
  EXPECT_THAT(recording.warnings, IsEmpty());
}

TEST(PlainCsvTest, JitteringTimesAreNamed) {
  const MarkerRecording recording = ParseOrThrow(
      "time,a_x_mm,a_y_mm,a_z_mm\n0.000,1,2,3\n0.013,1,2,3\n0.020,1,2,3\n0.030,1,2,3\n");
  EXPECT_NEAR(recording.tracks.rate_hz(), 100, 1e-9);
  EXPECT_THAT(Joined(recording.warnings), HasSubstr("departs by up to 3 ms"));
}

}  // namespace
}  // namespace articap
