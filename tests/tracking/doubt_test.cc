// SPDX-License-Identifier: MIT
#include "tracking/doubt.h"

#include <gmock/gmock.h>

#include <set>
#include <utility>

#include "tests/tracking/labelled_take.h"

namespace articap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::vector<std::string> kNames = {"nose", "chin", "lip"};

std::vector<Doubt> DoubtsOf(const LabelledTake& take) {
  const MarkerRecording recording = take.Recording();
  const TakeReview review =
      ReviewOf(take.clouds, take.labelling, recording, take.array, take.instants);
  return DoubtsOf(review, take.labelling, recording.tracks);
}

TEST(DoubtTest, ThereAreNoneAboutAGoodTake) {
  EXPECT_THAT(DoubtsOf(MakeLabelledTake(kNames, 200)), IsEmpty());
}

TEST(DoubtTest, AnExchangeOfNamesIsSeenWhereItBeginsAndEnds) {
  LabelledTake take = MakeLabelledTake(kNames, 200);
  for (int frame = 50; frame < 90; ++frame)
    std::swap(take.labelling.frames[frame].points[0], take.labelling.frames[frame].points[1]);
  const auto doubts = DoubtsOf(take);
  ASSERT_THAT(doubts, SizeIs(2));
  std::set<int> frames;
  for (const Doubt& doubt : doubts) {
    frames.insert(doubt.frame);
    EXPECT_EQ(doubt.kind, DoubtKind::kSwap);
    EXPECT_EQ(doubt.marker, 0);
    EXPECT_EQ(doubt.other, 1);
    EXPECT_THAT(doubt.why, HasSubstr("chin"));
  }
  EXPECT_EQ(frames, (std::set<int>{50, 90}));
}

TEST(DoubtTest, WhatIsUnseenForLongIsOneDoubtInItsMiddle) {
  LabelledTake take = MakeLabelledTake(kNames, 200);
  for (int frame = 60; frame < 101; ++frame) take.labelling.frames[frame].points[2] = -1;
  for (int frame = 120; frame < 130; ++frame) take.labelling.frames[frame].points[2] = -1;
  const auto doubts = DoubtsOf(take);
  ASSERT_THAT(doubts, SizeIs(1)) << "ten frames are not long";
  EXPECT_EQ(doubts[0].kind, DoubtKind::kFill);
  EXPECT_EQ(doubts[0].frame, 80);
  EXPECT_EQ(doubts[0].first, 60);
  EXPECT_EQ(doubts[0].last, 100);
  EXPECT_THAT(doubts[0].why, HasSubstr("0.68 s, a gap"));
}

TEST(DoubtTest, LargeResidualsCloseTogetherAreOneDoubtTheWorst) {
  LabelledTake take = MakeLabelledTake(kNames, 200);
  for (const int frame : {20, 21, 24, 60}) take.PointOf(frame, 1).residual_px = 0.3;
  take.PointOf(21, 1).residual_px = 0.96;  // 32 times the usual, 8 times where looking begins
  const auto doubts = DoubtsOf(take);
  ASSERT_THAT(doubts, SizeIs(2));
  EXPECT_EQ(doubts[0].kind, DoubtKind::kResidual);
  EXPECT_EQ(doubts[0].frame, 21);
  EXPECT_EQ(doubts[0].first, 20);
  EXPECT_EQ(doubts[0].last, 24);
  EXPECT_NEAR(doubts[0].score, 4, 1e-6);
  EXPECT_EQ(doubts[1].frame, 60);
}

TEST(DoubtTest, LabelsThatAreHardlyBetterThanOthersAreDoubtful) {
  LabelledTake take = MakeLabelledTake(kNames, 200);
  take.labelling.frames[7].margins[1] = 0.75F;
  take.labelling.frames[9].margins[0] = 3.5F;
  const auto doubts = DoubtsOf(take);
  ASSERT_THAT(doubts, SizeIs(1));
  EXPECT_EQ(doubts[0].kind, DoubtKind::kMargin);
  EXPECT_NEAR(doubts[0].score, 1.75, 1e-6);
}

TEST(DoubtTest, TheFirstAreSpreadOverTheTake) {
  std::vector<Doubt> doubts;
  for (int i = 0; i < 10; ++i) {
    Doubt doubt;
    doubt.frame = i;
    doubt.score = 20 - i;
    doubts.push_back(doubt);
  }
  for (const int frame : {40, 80}) {
    Doubt doubt;
    doubt.frame = frame;
    doubt.score = frame == 40 ? 1.5 : 2;
    doubts.push_back(doubt);
  }
  std::stable_sort(doubts.begin(), doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.score > b.score; });
  const auto spread = SpreadFirst(doubts, 4, 100);
  ASSERT_THAT(spread, SizeIs(doubts.size()));
  std::vector<int> frames;
  for (const Doubt& doubt : spread) frames.push_back(doubt.frame);
  EXPECT_THAT(frames, testing::ElementsAre(0, 1, 80, 40, 2, 3, 4, 5, 6, 7, 8, 9));
}

}  // namespace
}  // namespace articap
