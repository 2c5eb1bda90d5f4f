// SPDX-License-Identifier: MIT
// Recordings of real faces; see ARTICAP_TEST_DATA in tests/support/test_data.h.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/marker_io.h"
#include "tests/support/test_data.h"
#include "tracking/stabilize.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

MarkerSet Map(const std::string& name) {
  auto set = ReadMarkerSet(SourceFolder() / "maps" / (name + ".toml"));
  EXPECT_TRUE(set) << set.error().message;
  return set.value_or(MarkerSet{});
}

StageResult<Stabilized> StabilizeFile(const std::string& file, const MarkerSet& set,
                                      std::vector<std::string> head = {}) {
  const auto recording = ReadMarkers(TestDataPath(file));
  EXPECT_TRUE(recording) << recording.error().message;
  if (!recording) return {};
  StabilizeOptions options;
  options.head = std::move(head);
  auto result = Stabilize(recording->tracks, set, std::nullopt, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : StageResult<Stabilized>{};
}

double RangeOf(const HeadTracks& tracks, const std::string& name, int axis) {
  double low = 1e9, high = -1e9;
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    const double value = tracks.position_mm(frame, *tracks.Find(name))[axis];
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return high - low;
}

double FigureOf(const StageReport& report, const std::string& name) {
  for (const auto& [figure, value] : report.figures)
    if (figure == name) return value;
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

std::string TextOf(const StageReport& report, const std::string& name) {
  for (const auto& [text, value] : report.texts)
    if (text == name) return value;
  return "";
}

const std::vector<std::string> kForehead = {"ForeHead_M", "ForeHead_L", "ForeHead_R"};

TEST(RealHeadsTest, TheJawTakeIsStabilised) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const auto result = StabilizeFile("animface/jaw.trc", Map("animface"));
  EXPECT_EQ(FigureOf(result.report, "frames_ok"), 1590);
  EXPECT_LT(FigureOf(result.report, "residual_rms_mm"), 0.5);
  EXPECT_THAT(result.report.warnings, IsEmpty());
  // Forward and back the chin moves by 38 mm, whichever well-conditioned set finds the head.
  EXPECT_NEAR(RangeOf(result.output.tracks, "Chin", 2), 38, 1.5);
  EXPECT_NEAR(RangeOf(result.output.tracks, "Chin", 1), 39.5, 1);
}

TEST(RealHeadsTest, TheForeheadTriangleIsIllConditionedAndABetterSetIsProposed) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const auto triangle = StabilizeFile("animface/jaw.trc", Map("animface"), kForehead);
  // Its own residual looks splendid: a triangle cannot show its errors.
  EXPECT_LT(FigureOf(triangle.report, "residual_rms_mm"), 0.2);
  EXPECT_GT(RangeOf(triangle.output.tracks, "Chin", 2), 42);
  EXPECT_GT(FigureOf(triangle.report, "error_gain"), 5);
  EXPECT_THAT(triangle.report.warnings,
              Contains(AllOf(HasSubstr("ill-conditioned"), HasSubstr("'Chin'"))));
  EXPECT_THAT(triangle.report.warnings,
              Contains(AllOf(HasSubstr("a better set"), HasSubstr("NoseTop"))));
  const std::string names = TextOf(triangle.report, "proposed_references");
  std::vector<std::string> proposed;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t comma = std::min(names.find(',', at), names.size());
    proposed.push_back(names.substr(at, comma - at));
    at = comma + 1;
  }
  const auto better = StabilizeFile("animface/jaw.trc", Map("animface"), proposed);
  EXPECT_LT(FigureOf(better.report, "stillness_mm"),
            0.65 * FigureOf(triangle.report, "stillness_mm"));
  EXPECT_NEAR(RangeOf(better.output.tracks, "Chin", 2), 38, 1.5);
}

TEST(RealHeadsTest, TheForeheadIsNotRigidWhereTheBrowsMove) {
  ARTICAP_NEEDS_TEST_DATA("animface/cheeks.trc");
  for (const auto& head : {std::vector<std::string>{}, kForehead}) {
    const auto result = StabilizeFile("animface/cheeks.trc", Map("animface"), head);
    EXPECT_THAT(result.report.warnings,
                Contains(AllOf(HasSubstr("not rigid"), HasSubstr("'ForeHead_M'"),
                               HasSubstr("'ForeHead_L'"), HasSubstr("'ForeHead_R'"))));
  }
}

TEST(RealHeadsTest, TwoTakesShareOneShape) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  ARTICAP_NEEDS_TEST_DATA("animface/cheeks.trc");
  const MarkerSet set = Map("animface");
  const auto jaw = StabilizeFile("animface/jaw.trc", set);
  const auto cheeks = ReadMarkers(TestDataPath("animface/cheeks.trc"));
  ASSERT_TRUE(cheeks);
  const auto result = Stabilize(cheeks->tracks, set, jaw.output.head_shape);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->report.IsUsable());
}

TEST(RealHeadsTest, MirroredRealDataAreRefused) {
  ARTICAP_NEEDS_TEST_DATA("animface/jaw.trc");
  const auto recording = ReadMarkers(TestDataPath("animface/jaw.trc"));
  ASSERT_TRUE(recording);
  const auto result = Stabilize(MirrorTracks(recording->tracks), Map("animface"), std::nullopt);
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("--mirror"));
}

TEST(RealHeadsTest, TheArticulographSentenceNeedsOnlyItsAxes) {
  ARTICAP_NEEDS_TEST_DATA("speech/F01_B01_S01_R01_N.trc");
  const auto result = StabilizeFile("speech/F01_B01_S01_R01_N.trc", Map("haskins_ema"));
  EXPECT_EQ(FigureOf(result.report, "frames_ok"), 262);
  EXPECT_THAT(result.report.warnings, IsEmpty());
  const HeadTracks& head = result.output.tracks;
  // The left corner of the mouth is to the left, the upper lip above and before it.
  EXPECT_GT(head.position_mm(0, *head.Find("ML")).x(), 20);
  EXPECT_GT(head.position_mm(0, *head.Find("UL")).y(), head.position_mm(0, *head.Find("LL")).y());
  EXPECT_GT(head.position_mm(0, *head.Find("UL")).z(), head.position_mm(0, *head.Find("ML")).z());
}

}  // namespace
}  // namespace articap
