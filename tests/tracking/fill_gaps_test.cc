// SPDX-License-Identifier: MIT
#include "tracking/fill_gaps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "synthetic/noise.h"
#include "tests/support/matchers.h"
#include "tests/support/report_figures.h"
#include "tests/support/spoken_take.h"
#include "tests/tracking/gap_cuts.h"
#include "tests/tracking/head_scene.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRate_hz = 60;

StageResult<StageTracks> Fill(const StageTracks& tracks, const FillOptions& options = {}) {
  auto result = FillGaps(tracks, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : StageResult<StageTracks>{};
}

void Cut(StageTracks& tracks, const std::string& name, int first, int length) {
  for (int k = 0; k < length; ++k) tracks.SetMissing(first + k, *tracks.Find(name));
}

// What was there is as it was; what is there besides is filled, finite, and has an error that is
// not negative.
void ExpectOnlyFilled(const StageTracks& before, const StageTracks& after) {
  ASSERT_EQ(before.num_frames(), after.num_frames());
  ASSERT_EQ(before.names(), after.names());
  for (int frame = 0; frame < before.num_frames(); ++frame)
    for (int marker = 0; marker < before.num_markers(); ++marker) {
      if (!before.is_missing(frame, marker)) {
        ASSERT_EQ(before.state(frame, marker), after.state(frame, marker));
        ASSERT_EQ(before.position_mm(frame, marker), after.position_mm(frame, marker));
      } else if (!after.is_missing(frame, marker)) {
        ASSERT_EQ(after.state(frame, marker), SampleState::kFilled);
        ASSERT_TRUE(after.position_mm(frame, marker).allFinite());
        ASSERT_FALSE(after.sigma_mm(frame, marker) <= 0);
      }
    }
}

int CountMissing(const StageTracks& tracks) {
  int count = 0;
  for (int marker = 0; marker < tracks.num_markers(); ++marker)
    count += tracks.CountMissing(marker);
  return count;
}

double RmsError(const StageTracks& truth, const StageTracks& filled, const std::string& name) {
  double sum_mm2 = 0;
  int count = 0;
  const int marker = *filled.Find(name);
  for (int frame = 0; frame < filled.num_frames(); ++frame) {
    if (filled.state(frame, marker) != SampleState::kFilled) continue;
    sum_mm2 += (filled.position_mm(frame, marker) - truth.position_mm(frame, marker)).squaredNorm();
    ++count;
  }
  EXPECT_GT(count, 0);
  return std::sqrt(sum_mm2 / std::max(1, count));
}

// A marker on a slow circle.
StageTracks OneMarker(int num_frames) {
  StageTracks tracks({"alone"}, num_frames, kRate_hz);
  for (int frame = 0; frame < num_frames; ++frame)
    tracks.Set(frame, 0, {10 * std::cos(0.05 * frame), 10 * std::sin(0.05 * frame), 500});
  return tracks;
}

TEST(FillGapsTest, ATakeWithoutGapsStaysAsItIs) {
  const HeadScene scene = MakeHeadScene({.num_frames = 50});
  const auto result = Fill(scene.tracks);
  EXPECT_THAT(result.output, TracksNear(scene.tracks, 0));
  EXPECT_EQ(result.report.verdict, "the take has no gaps");
}

TEST(FillGapsTest, TheSyntheticSpeakerIsFilledWithHonestErrors) {
  const SpokenTake spoken = MakeSpokenTake({.num_sentences = 4});
  const double noise_mm = 0.1;
  const SyntheticNoiseOptions noise{.noise_mm = noise_mm};
  SyntheticNoiseOptions gaps = noise;
  gaps.gap = 0.05;
  gaps.dropout = 0.02;
  // The noise is the same with gaps as without.
  const StageTracks whole = AddNoise(spoken.take.markers, noise, 3).markers.tracks;
  const StageTracks cut = AddNoise(spoken.take.markers, gaps, 3).markers.tracks;
  const StageTracks& truth = spoken.take.markers.tracks;
  const auto result = Fill(cut, {.longest_at_end_s = 0});
  ExpectOnlyFilled(cut, result.output);

  double error_mm2 = 0;
  double over_variance = 0;
  int count = 0;
  for (int frame = 0; frame < cut.num_frames(); ++frame)
    for (int marker = 0; marker < cut.num_markers(); ++marker) {
      if (result.output.state(frame, marker) != SampleState::kFilled) continue;
      const Eigen::Vector3d filled_mm = result.output.position_mm(frame, marker);
      error_mm2 += (filled_mm - truth.position_mm(frame, marker)).squaredNorm();
      over_variance += (filled_mm - whole.position_mm(frame, marker)).squaredNorm() / 3 /
                       std::pow(result.output.sigma_mm(frame, marker), 2);
      ++count;
    }
  ASSERT_GT(count, 1000);
  // Regression on as many markers averages the noise of their measurement: what is filled is as
  // good as measured.
  EXPECT_LT(std::sqrt(error_mm2 / count / 3), 2 * noise_mm);
  EXPECT_NEAR(std::sqrt(over_variance / count), 1, 0.3);
  EXPECT_EQ(FigureOf(result.report, "filled_samples"), count);
}

TEST(FillGapsTest, AHiddenReferenceFollowsTheOthers) {
  const HeadScene truth = MakeHeadScene({.noise_mm = 0});
  HeadScene scene = MakeHeadScene({.noise_mm = 0.1});
  const std::string name = scene.references.points.front().name;
  for (const int first : {60, 160, 260}) Cut(scene.tracks, name, first, 30);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  // The other references know its place a little worse than their own noise.
  EXPECT_LT(RmsError(truth.tracks, result.output, name), 2 * std::sqrt(3) * 0.1);
}

TEST(FillGapsTest, SeveralReferencesMayHideAtOnce) {
  const HeadScene truth = MakeHeadScene({.noise_mm = 0});
  HeadScene scene = MakeHeadScene({.noise_mm = 0.1});
  ASSERT_GE(scene.references.points.size(), 5);
  // Two are left: the head's movement is interpolated.
  for (int i = 0; i < 3; ++i) Cut(scene.tracks, scene.references.points[i].name, 100, 4);
  Cut(scene.tracks, "chin", 98, 10);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 0);
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(RmsError(truth.tracks, result.output, scene.references.points[i].name), 0.5);
}

TEST(FillGapsTest, AHiddenChinFollowsTheFace) {
  const HeadScene truth = MakeHeadScene({.noise_mm = 0});
  HeadScene scene = MakeHeadScene({.noise_mm = 0.1});
  for (const int first : {60, 160, 260}) Cut(scene.tracks, "chin", first, 30);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  // The jaw opens by 12 mm four times a second: half a second of it is seen by other markers alone.
  EXPECT_LT(RmsError(truth.tracks, result.output, "chin"), 0.5);
}

TEST(FillGapsTest, ARecordingThatIsFixedToTheHeadIsFilledWhereItIs) {
  HeadScene scene = MakeHeadScene({.noise_mm = 0.1});
  for (int frame = 0; frame < scene.tracks.num_frames(); ++frame)
    for (int marker = 0; marker < scene.tracks.num_markers(); ++marker)
      scene.tracks.Set(frame, marker,
                       scene.truth_from_stage[frame] * scene.tracks.position_mm(frame, marker));
  const StageTracks whole = scene.tracks;
  for (const int first : {60, 160, 260}) Cut(scene.tracks, "chin", first, 30);
  const auto result = Fill(scene.tracks, {.follow_head = false});
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_LT(RmsError(whole, result.output, "chin"), 0.5);
}

TEST(FillGapsTest, GapsAtTheEndsAreFilledFromOthers) {
  const HeadScene truth = MakeHeadScene({.noise_mm = 0});
  HeadScene scene = MakeHeadScene({.noise_mm = 0.1});
  Cut(scene.tracks, "chin", 0, 12);
  Cut(scene.tracks, "chin", scene.tracks.num_frames() - 12, 12);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 0);
  EXPECT_LT(RmsError(truth.tracks, result.output, "chin"), 1);
}

TEST(FillGapsTest, LongGapsStay) {
  HeadScene scene = MakeHeadScene({});
  Cut(scene.tracks, "chin", 100, 30);
  Cut(scene.tracks, "nose_bridge", 100, 31);
  Cut(scene.tracks, "lower_lip_center", 0, 16);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 31 + 16);
  EXPECT_THAT(result.report.verdict, HasSubstr("30 of 77"));
  EXPECT_THAT(result.report.verdict, HasSubstr("47 are left"));
  const FillOptions none{.longest_s = 0, .longest_at_end_s = 0};
  EXPECT_THAT(Fill(scene.tracks, none).output, TracksNear(scene.tracks, 0));
}

TEST(FillGapsTest, EverythingMayBeMissingAtOnce) {
  const HeadScene truth = MakeHeadScene({.noise_mm = 0});
  HeadScene scene = MakeHeadScene({.noise_mm = 0.1});
  for (const std::string& name : scene.tracks.names()) Cut(scene.tracks, name, 200, 3);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 0);
  EXPECT_LT(RmsError(truth.tracks, result.output, scene.references.points[0].name), 0.6);
}

TEST(FillGapsTest, AShotThroughTakeIsFilled) {
  const HeadScene truth = MakeHeadScene({.noise_mm = 0});
  const HeadScene scene = MakeHeadScene({.noise_mm = 0.1, .dropout = 0.3});
  const auto result = Fill(scene.tracks, {.longest_at_end_s = 0});
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_LT(RmsError(truth.tracks, result.output, scene.references.points[0].name), 0.5);
  EXPECT_LT(RmsError(truth.tracks, result.output, "chin"), 1);
}

TEST(FillGapsTest, TheSameTakeIsFilledTheSameWay) {
  HeadScene scene = MakeHeadScene({.dropout = 0.05});
  const auto first = Fill(scene.tracks);
  const auto second = Fill(scene.tracks);
  EXPECT_THAT(second.output, TracksNear(first.output, 0));
  EXPECT_EQ(first.report.ToJson(), second.report.ToJson());
}

TEST(FillGapsTest, FilledSamplesOfOthersStay) {
  HeadScene scene = MakeHeadScene({});
  const int chin = *scene.tracks.Find("chin");
  scene.tracks.Set(50, chin, scene.tracks.position_mm(50, chin), SampleState::kFilled, 3);
  Cut(scene.tracks, "chin", 51, 4);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_EQ(result.output.sigma_mm(50, chin), 3);
}

TEST(FillGapsTest, OneMarkerAloneIsInterpolated) {
  const StageTracks truth = OneMarker(400);
  StageTracks tracks = truth;
  Cut(tracks, "alone", 100, 10);
  Cut(tracks, "alone", 0, 5);
  const auto result = Fill(tracks);
  ExpectOnlyFilled(tracks, result.output);
  // Nobody knows where it came from.
  EXPECT_EQ(CountMissing(result.output), 5);
  EXPECT_LT(RmsError(truth, result.output, "alone"), 0.01);
}

TEST(FillGapsTest, AMarkerThatStandsStillStaysThere) {
  StageTracks tracks({"still"}, 100, kRate_hz);
  for (int frame = 0; frame < 100; ++frame) tracks.Set(frame, 0, {1, 2, 3});
  Cut(tracks, "still", 40, 7);
  const auto result = Fill(tracks);
  ExpectOnlyFilled(tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 0);
  EXPECT_THAT(result.output.position_mm(43, 0), PointNear(Eigen::Vector3d(1, 2, 3), 1e-9));
}

TEST(FillGapsTest, AFewFramesTeachNothingButAreFilled) {
  StageTracks tracks = OneMarker(9);
  Cut(tracks, "alone", 4, 1);
  const auto result = Fill(tracks);
  ExpectOnlyFilled(tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 0);
  EXPECT_TRUE(std::isnan(result.output.sigma_mm(4, 0)));
  EXPECT_THAT(result.report.warnings, testing::ElementsAre(HasSubstr("errors of 1 filled")));
}

TEST(FillGapsTest, WhatCannotBeFilledStays) {
  for (const int num_frames : {0, 1, 2}) {
    const StageTracks nothing({"chin", "nose_bridge"}, num_frames, kRate_hz);
    EXPECT_EQ(CountMissing(Fill(nothing).output), 2 * num_frames);
  }
  StageTracks two = OneMarker(2);
  two.SetMissing(1, 0);
  EXPECT_EQ(CountMissing(Fill(two).output), 1);
  const StageTracks nobody({}, 10, kRate_hz);
  EXPECT_EQ(Fill(nobody).output.num_markers(), 0);
}

TEST(FillGapsTest, MarkersNeverSeenAreNamed) {
  HeadScene scene = MakeHeadScene({.num_frames = 100});
  Cut(scene.tracks, "chin", 0, 100);
  Cut(scene.tracks, scene.references.points[0].name, 0, 100);
  Cut(scene.tracks, "nose_bridge", 50, 3);
  const auto result = Fill(scene.tracks);
  ExpectOnlyFilled(scene.tracks, result.output);
  EXPECT_EQ(CountMissing(result.output), 200);
  EXPECT_THAT(result.report.warnings, testing::Contains(HasSubstr("'chin' is never seen")));
}

TEST(FillGapsTest, TheReportTellsWhatWasDone) {
  HeadScene scene = MakeHeadScene({});
  const std::string reference = scene.references.points[0].name;
  Cut(scene.tracks, "chin", 100, 20);
  Cut(scene.tracks, "chin", 200, 10);
  Cut(scene.tracks, reference, 150, 5);
  const StageReport report = Fill(scene.tracks).report;
  EXPECT_TRUE(report.IsUsable());
  EXPECT_THAT(report.warnings, IsEmpty());
  ASSERT_EQ(report.tables.size(), 1);
  ASSERT_EQ(report.tables[0].rows.size(), 2);
  for (const ReportTable::Row& row : report.tables[0].rows) {
    // gaps, longest, missing, by regression, by interpolation, left
    const std::vector<double> counts(row.values.begin(), row.values.end() - 1);
    if (row.label == reference)
      EXPECT_THAT(counts, testing::ElementsAre(1, 5, 5, 5, 0, 0));
    else
      EXPECT_THAT(counts, testing::ElementsAre(2, 20, 30, 30, 0, 0));
    EXPECT_GT(row.values.back(), 0);
    EXPECT_LT(row.values.back(), 1);
  }
}

TEST(FillGapsTest, NoCameraSawWhatIsFilled) {
  MarkerRecording recording{.tracks = OneMarker(100)};
  recording.residuals_mm.assign(100, 0.2F);
  recording.camera_masks.assign(100, 3);
  Cut(recording.tracks, "alone", 50, 2);
  for (const int frame : {50, 51}) {
    recording.residuals_mm[frame] = std::nanf("");
    recording.camera_masks[frame] = 0;
  }
  const auto result = FillGaps(recording);
  ASSERT_TRUE(result);
  ExpectOnlyFilled(recording.tracks, result->output.tracks);
  EXPECT_EQ(CountMissing(result->output.tracks), 0);
  EXPECT_EQ(result->output.residuals_mm[49], 0.2F);
  EXPECT_EQ(result->output.residuals_mm[50], 0);
  EXPECT_EQ(result->output.camera_masks[49], 3);
  EXPECT_EQ(result->output.camera_masks[51], 0);
}

TEST(FillGapsTest, NegativeLengthsAreRefused) {
  const auto result = FillGaps(OneMarker(10), {.longest_s = -1});
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("longest_s"));
}

}  // namespace
}  // namespace articap
