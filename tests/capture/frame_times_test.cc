// SPDX-License-Identifier: MIT
#include "capture/frame_times.h"

#include <gmock/gmock.h>

#include <cmath>

namespace articap {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kRate_hz = 50;
const SessionTime kStart{milliseconds(1000)};

// In ms on the session clock; -1 stands for a frame without a time.
std::vector<long> Times(FrameTimes& times, const std::vector<int>& own_ms) {
  std::vector<long> seen_ms;
  for (const int own : own_ms) {
    const auto told = own < 0 ? std::optional<nanoseconds>() : milliseconds(own);
    seen_ms.push_back(std::lround(SecondsOf(times.Next(told)) * 1e3));
  }
  return seen_ms;
}

TEST(FrameTimesTest, TheFirstFrameIsTheStart) {
  FrameTimes times(kRate_hz, milliseconds(1), kStart);
  EXPECT_THAT(Times(times, {1400, 1420, 1441, 1460}), ElementsAre(1000, 1020, 1041, 1060));
  EXPECT_TRUE(times.constant_rate());
  EXPECT_THAT(times.notes(), IsEmpty());
}

TEST(FrameTimesTest, FramesWithoutTimesGoOn) {
  FrameTimes times(kRate_hz, milliseconds(1), kStart);
  EXPECT_THAT(Times(times, {0, -1, 40, -1, -1}), ElementsAre(1000, 1020, 1040, 1060, 1080));
  EXPECT_TRUE(times.constant_rate());
  EXPECT_THAT(times.notes(), ElementsAre(HasSubstr("3 of 5 frames have no time")));
}

TEST(FrameTimesTest, GapsRepetitionsAndIrregularTimesStayAndAreNoted) {
  FrameTimes gap(kRate_hz, milliseconds(1), kStart);
  EXPECT_THAT(Times(gap, {0, 20, 80, 100}), ElementsAre(1000, 1020, 1080, 1100));
  EXPECT_FALSE(gap.constant_rate());
  EXPECT_THAT(gap.notes(), ElementsAre(HasSubstr("before frame 2")));
  FrameTimes repeated(kRate_hz, milliseconds(1), kStart);
  EXPECT_THAT(Times(repeated, {0, 20, 20, 60}), ElementsAre(1000, 1020, 1020, 1060));
  EXPECT_THAT(repeated.notes(),
              ElementsAre(HasSubstr("the first of them frame 2"), HasSubstr("1 gaps")));
  FrameTimes irregular(kRate_hz, milliseconds(1), kStart);
  EXPECT_THAT(Times(irregular, {0, 20, 33, 60}), ElementsAre(1000, 1020, 1033, 1060));
  EXPECT_FALSE(irregular.constant_rate());
  EXPECT_THAT(irregular.notes(), ElementsAre(HasSubstr("2 of 4 frames do not come")));
}

TEST(FrameTimesTest, FurtherPartsFollowTheFrameBefore) {
  FrameTimes anew(kRate_hz, milliseconds(1), kStart);
  Times(anew, {0, 20});
  EXPECT_EQ(anew.Next(milliseconds(0), true), kStart + milliseconds(40));
  EXPECT_EQ(anew.Next(milliseconds(20)), kStart + milliseconds(60));
  EXPECT_THAT(anew.notes(), ElementsAre(HasSubstr("frame 2")));
  FrameTimes goes_on(kRate_hz, milliseconds(1), kStart);
  Times(goes_on, {0, 20});
  EXPECT_EQ(goes_on.Next(milliseconds(41), true), kStart + milliseconds(41));
  EXPECT_THAT(goes_on.notes(), IsEmpty());
}

TEST(FrameTimesTest, AClockThatJumpsBackIsJoined) {
  FrameTimes times(kRate_hz, milliseconds(1), kStart);
  EXPECT_THAT(Times(times, {500, 520, 0, 20}), ElementsAre(1000, 1020, 1040, 1060));
  EXPECT_THAT(times.notes(), ElementsAre(HasSubstr("frame 2: the file's clock begins anew")));
}

}  // namespace
}  // namespace articap
