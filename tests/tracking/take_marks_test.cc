// SPDX-License-Identifier: MIT
#include "tracking/take_marks.h"

#include <gmock/gmock.h>

#include "tests/tracking/labelled_take.h"

namespace articap {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

const std::vector<std::string> kNames = {"nose", "chin"};

// The marks of a marker in a frame.
std::vector<MarkerMark> MarksOf(const LabelledTake& take, const MarkerRecording& recording,
                                int frame, int marker) {
  const TakeReview review =
      ReviewOf(take.clouds, take.labelling, recording, take.array, take.instants);
  const TakeMarks marks(take.array, take.clouds, take.labelling, recording.tracks, review,
                        take.instants);
  std::vector<MarkerMark> of_marker;
  for (const MarkerMark& mark : marks.At(frame).markers)
    if (mark.marker == marker) of_marker.push_back(mark);
  return of_marker;
}

TEST(TakeMarksTest, DotsAreWhereTheyWereFound) {
  const LabelledTake take = MakeLabelledTake(kNames, 10);
  const auto marks = MarksOf(take, take.Recording(), 4, 1);
  ASSERT_THAT(marks, SizeIs(2));
  for (const MarkerMark& mark : marks) {
    ASSERT_TRUE(mark.dot_px);
    EXPECT_EQ(*mark.dot_px, take.instants[4][mark.view.camera][1].center_px);
    EXPECT_NEAR((*mark.dot_px - mark.place_px).norm(), 0, 1e-9);
    EXPECT_NEAR(mark.diameter_px, 6, 1e-9);
  }
}

// The head moves by 7 mm in the frame itself, the markers within it hardly at all.
TEST(TakeMarksTest, HiddenMarkersAreExpectedToMoveWithTheHead) {
  LabelledTake take = MakeLabelledTake(kNames, 60);
  const Eigen::Vector3d truth = take.PointOf(30, 0).position_in_stage_mm;
  const Eigen::Vector3d jump(7, 0, 0);
  take.labelling.frames[30].points[0] = -1;
  take.labelling.frames[30].template_from_stage->translation_mm = -jump;
  const auto marks = MarksOf(take, take.Recording(), 30, 0);
  ASSERT_THAT(marks, SizeIs(2));
  for (const MarkerMark& mark : marks) {
    EXPECT_FALSE(mark.dot_px);
    const Eigen::Vector2d expected_px = *Project(take.array, mark.view, truth + jump);
    // 0.3 mm: the nod's curvature over two frames, and the noise.
    EXPECT_LT((mark.place_px - expected_px).norm(), 0.3);
  }
}

TEST(TakeMarksTest, ViewsThatNeverShowAMarkerAreLeftOut) {
  LabelledTake take = MakeLabelledTake(kNames, 60);
  for (int frame = 0; frame < 60; ++frame) take.PointOf(frame, 0).sights.resize(1);
  const auto marks = MarksOf(take, take.Recording(), 30, 0);
  ASSERT_THAT(marks, SizeIs(1));
  EXPECT_EQ(marks[0].view, (View{0, -1}));
}

TEST(TakeMarksTest, DotsWithoutANameAreSpare) {
  LabelledTake take = MakeLabelledTake(kNames, 60);
  for (auto& frame : take.labelling.frames) frame.points[1] = -1;
  const MarkerRecording recording = take.Recording();
  const TakeReview review =
      ReviewOf(take.clouds, take.labelling, recording, take.array, take.instants);
  const TakeMarks marks(take.array, take.clouds, take.labelling, recording.tracks, review,
                        take.instants);
  const FrameMarks frame = marks.At(7);
  ASSERT_THAT(frame.spare_dots, SizeIs(2));
  EXPECT_EQ(frame.spare_dots[1].camera, 1);
  EXPECT_EQ(frame.spare_dots[1].center_px, take.instants[7][1][1].center_px);
  EXPECT_THAT(MarksOf(take, recording, 7, 1), IsEmpty()) << "a marker that was never seen";
}

}  // namespace
}  // namespace articap
