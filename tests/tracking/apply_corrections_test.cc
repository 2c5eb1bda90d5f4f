// SPDX-License-Identifier: MIT
#include "tracking/apply_corrections.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "core/check.h"
#include "tests/support/matchers.h"
#include "tests/support/result.h"
#include "tests/tracking/labelled_take.h"
#include "tracking/reconstruct.h"

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// Far enough apart, and not in a plane or a line, so that the head can be found: three markers on
// a row would not tell how it is turned.
LabelledTake FaceOfDots(int num_frames) {
  LabelledTake take = MakeLabelledTake({"nose", "chin", "left", "right", "brow"}, num_frames);
  const Eigen::Vector3d places_mm[] = {
      {0, 0, 0}, {3, 70, -10}, {40, 35, -25}, {-38, 38, -20}, {2, -45, -12}};
  for (int m = 0; m < 5; ++m) {
    take.marker_template.markers[m].position_mm = places_mm[m];
    for (int frame = 0; frame < num_frames; ++frame) {
      CloudPoint& point = take.PointOf(frame, m);
      point.position_in_stage_mm = places_mm[m] + Eigen::Vector3d(0, 5 * std::sin(0.1 * frame), 0);
      for (const DotSight& sight : point.sights)
        take.instants[frame][sight.view.camera][sight.dot].center_px =
            *Project(take.array, sight.view, point.position_in_stage_mm);
    }
  }
  return take;
}

AppliedCorrections Corrected(const std::string& toml_text, int first_frame = 1) {
  return AppliedCorrections(OrThrow(ParseCorrections(toml_text, "c.toml")), first_frame);
}

struct Outcome {
  Labelling labelling;
  StageReport report;
  PointClouds clouds;
};

// The whole way from dots, or from the take's own points.
Outcome Apply(LabelledTake take, const std::string& toml_text, bool from_dots = false) {
  AppliedCorrections corrections = Corrected(toml_text);
  ARTICAP_CHECK(corrections.CheckViews(take.array).has_value());
  ARTICAP_CHECK(corrections.CheckMarkers(take.marker_template).has_value());
  corrections.CorrectDots(take.array, take.instants);
  if (from_dots) take.clouds.frames = Reconstruct(take.array, take.instants, {});
  Outcome outcome;
  outcome.labelling =
      corrections.Label(take.clouds, take.marker_template, {}, take.array, take.instants);
  outcome.report = corrections.Report();
  outcome.clouds = take.clouds;
  return outcome;
}

int PointOf(const Outcome& outcome, int frame, int marker) {
  return outcome.labelling.frames[frame].points[marker];
}

TEST(ApplyCorrectionsTest, WithoutAnyLabelsAreAsTheyWere) {
  const Outcome outcome = Apply(FaceOfDots(60), "");
  for (int frame = 0; frame < 60; ++frame)
    EXPECT_THAT(outcome.labelling.frames[frame].points, ElementsAre(0, 1, 2, 3, 4));
}

TEST(ApplyCorrectionsTest, SwapExchangesTheNamesInItsFramesAlone) {
  const Outcome outcome =
      Apply(FaceOfDots(60), "[[swap]]\nmarkers = ['left', 'right']\nframes = [11, 20]\n");
  EXPECT_EQ(PointOf(outcome, 9, 2), 2);
  EXPECT_EQ(PointOf(outcome, 10, 2), 3);
  EXPECT_EQ(PointOf(outcome, 19, 3), 2);
  EXPECT_EQ(PointOf(outcome, 20, 3), 3);
  EXPECT_THAT(outcome.labelling.frames[10].margins[2], testing::IsNan());
  EXPECT_THAT(outcome.report.warnings, IsEmpty());
  EXPECT_EQ(outcome.report.figures[1].second, 20) << "ten frames of two markers";
}

TEST(ApplyCorrectionsTest, RelabelTakesTheNameFromWhoHadIt) {
  const Outcome outcome =
      Apply(FaceOfDots(60), "[[relabel]]\nmarker = 'left'\nis = 'right'\nframe = 30\n");
  EXPECT_EQ(PointOf(outcome, 29, 2), -1);
  EXPECT_EQ(PointOf(outcome, 29, 3), 2);
  EXPECT_EQ(PointOf(outcome, 30, 2), 2);
}

TEST(ApplyCorrectionsTest, CorrectionsFollowOneAnother) {
  const Outcome outcome = Apply(FaceOfDots(60),
                                "[[swap]]\nmarkers = ['left', 'right']\nframe = 30\n"
                                "[[delete]]\nmarker = 'left'\nframe = 30\n");
  EXPECT_EQ(PointOf(outcome, 29, 2), -1);
  EXPECT_EQ(PointOf(outcome, 29, 3), 2);
}

TEST(ApplyCorrectionsTest, ADeletedDotIsNoOnesAnyMore) {
  const LabelledTake take = FaceOfDots(60);
  const Eigen::Vector2d at = take.instants[30][0][1].center_px;
  const Outcome outcome = Apply(take,
                                fmt::format("[[delete]]\nview = 'left'\nframe = 31\n"
                                            "at_px = [{}, {}]\n",
                                            at.x() + 2, at.y() - 2),
                                true);
  EXPECT_EQ(outcome.report.figures[1].second, 1);
  const int chin = PointOf(outcome, 30, 1);
  ASSERT_GE(chin, 0);
  EXPECT_THAT(outcome.clouds.frames[30][chin].sights, SizeIs(1));
  const int before = PointOf(outcome, 29, 1);
  EXPECT_THAT(outcome.clouds.frames[29][before].sights, SizeIs(2));
}

// The left camera's dot of the chin is 4 px beside it, too far for the other view's ray: a person
// says where it is.
TEST(ApplyCorrectionsTest, AMovedPointIsTriangulatedAnew) {
  LabelledTake take = FaceOfDots(60);
  const Eigen::Vector3d truth = take.PointOf(30, 1).position_in_stage_mm;
  Dot& dot = take.instants[30][0][1];
  const Eigen::Vector2d right_place = dot.center_px;
  dot.center_px += Eigen::Vector2d(0, 4);
  const Outcome outcome = Apply(take,
                                fmt::format("[[move]]\nmarker = 'chin'\nview = 'left'\nframe = 31\n"
                                            "to_px = [{}, {}]\n",
                                            right_place.x(), right_place.y()),
                                true);
  const int chin = PointOf(outcome, 30, 1);
  ASSERT_GE(chin, 0);
  const CloudPoint& point = outcome.clouds.frames[30][chin];
  EXPECT_THAT(point.sights, SizeIs(2));
  EXPECT_THAT(point.position_in_stage_mm, PointNear(truth, 1e-3));
  EXPECT_THAT(outcome.report.warnings, IsEmpty());
}

TEST(ApplyCorrectionsTest, AMovedPointThatWasNotFoundIsAdded) {
  LabelledTake take = FaceOfDots(60);
  const Eigen::Vector3d truth = take.PointOf(30, 4).position_in_stage_mm;
  const Eigen::Vector2d place = take.instants[30][1][4].center_px;
  take.instants[30][1].pop_back();
  const Outcome outcome = Apply(take,
                                fmt::format("[[move]]\nmarker = 'brow'\nview = 'right'\n"
                                            "frame = 31\nto_px = [{}, {}]\n",
                                            place.x(), place.y()),
                                true);
  const int brow = PointOf(outcome, 30, 4);
  ASSERT_GE(brow, 0);
  EXPECT_THAT(outcome.clouds.frames[30][brow].sights, SizeIs(2));
  EXPECT_THAT(outcome.clouds.frames[30][brow].position_in_stage_mm, PointNear(truth, 1e-3));
}

// Both parts are searched for the head, and each begins anew.
TEST(ApplyCorrectionsTest, ASplitIsWhereTwoTakesMeet) {
  const LabelledTake take = FaceOfDots(60);
  EXPECT_EQ(Apply(take, "").labelling.searches, 1);
  const Outcome outcome = Apply(take, "[[split]]\nframe = 31\n");
  EXPECT_EQ(outcome.labelling.searches, 2);
  ASSERT_THAT(outcome.labelling.frames, SizeIs(60));
  EXPECT_THAT(outcome.labelling.frames[45].points, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(outcome.report.warnings, IsEmpty());
}

TEST(ApplyCorrectionsTest, NoGapIsFilledAcrossASplit) {
  LabelledTake take = FaceOfDots(60);
  for (int frame = 20; frame < 30; ++frame)
    for (const int marker : {1, 2}) take.labelling.frames[frame].points[marker] = -1;
  for (int frame = 40; frame < 45; ++frame) take.labelling.frames[frame].points[1] = -1;
  MarkerRecording recording = take.Recording();
  StageTracks& tracks = recording.tracks;
  for (int frame = 0; frame < 60; ++frame)
    for (const int marker : {1, 2})
      if (tracks.is_missing(frame, marker))
        tracks.Set(frame, marker, Eigen::Vector3d::Zero(), SampleState::kFilled);
  recording.residuals_mm[25 * 5 + 1] = 0;
  Corrected("[[split]]\nmarker = 'chin'\nframe = 26\n[[split]]\nframe = 41\n")
      .ClearFillsAcrossSplits(take.labelling, recording);
  EXPECT_EQ(tracks.CountMissing(1), 15) << "the gap from frame 41 on begins at a split";
  EXPECT_THAT(recording.residuals_mm[25 * 5 + 1], testing::IsNan());
  EXPECT_EQ(tracks.CountMissing(2), 0);
}

TEST(ApplyCorrectionsTest, WhatMatchedNothingIsNamedWithItsLine) {
  LabelledTake take = FaceOfDots(60);
  const Outcome outcome = Apply(take,
                                "\n[[delete]]\nmarker = 'chin'\nframes = [70, 90]\n"
                                "[[delete]]\nview = 'left'\nframe = 3\nat_px = [1, 1]\n"
                                "[[delete]]\nmarker = 'chin'\nframe = 3\n"
                                "[[delete]]\nmarker = 'chin'\nframe = 3\n"
                                "[[split]]\nframe = 1\n");
  ASSERT_THAT(outcome.report.warnings, SizeIs(4));
  EXPECT_THAT(outcome.report.warnings[0],
              HasSubstr("c.toml, line 2: delete chin, frames 70 to 90"));
  EXPECT_THAT(outcome.report.warnings[1],
              HasSubstr("line 5: delete the dot of left at (1.0, 1.0), frame 3"));
  EXPECT_THAT(outcome.report.warnings[2], HasSubstr("line 12"));
  EXPECT_THAT(outcome.report.warnings[3], HasSubstr("line 15: split"));
  EXPECT_THAT(outcome.report.verdict, HasSubstr("1 of 5"));
}

TEST(ApplyCorrectionsTest, UnknownNamesAreRefused) {
  const LabelledTake take = FaceOfDots(2);
  const auto of_marker =
      Corrected("[[delete]]\nmarker = 'chim'\nframe = 3\n").CheckMarkers(take.marker_template);
  ASSERT_FALSE(of_marker);
  EXPECT_THAT(of_marker.error().message,
              HasSubstr("c.toml, line 1: there is no marker 'chim'; there are nose, chin"));
  const std::string dot = "[[delete]]\nview = 'top'\nframe = 3\nat_px = [1, 1]\n";
  EXPECT_THAT(Corrected(dot).CheckViews(take.array).error().message,
              HasSubstr("there is no view 'top'; there are left, right"));
  EXPECT_THAT(Corrected(dot).CheckViews(CameraArray{}).error().message,
              HasSubstr("none in a file of markers"));
}

}  // namespace
}  // namespace articap
