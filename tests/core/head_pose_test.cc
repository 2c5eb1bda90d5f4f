// SPDX-License-Identifier: MIT
#include "core/head_pose.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/matchers.h"

namespace articap {
namespace {

using testing::HasSubstr;

HeadPoseTrack SampleTrack() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  HeadPoseTrack track{StabilizationMode::kRigid, 59.94, 101, SessionTimeFromSeconds(12.5), {}};
  for (int i = 0; i < 50; ++i) {
    HeadPose pose;
    pose.head_from_stage.rotation =
        Eigen::Quaterniond{normal(random), normal(random), normal(random), normal(random)}
            .normalized();
    pose.head_from_stage.translation_mm = {normal(random), 1e3 * normal(random), normal(random)};
    pose.residual_mm = std::abs(normal(random));
    if (i % 7 == 3) pose.status = HeadPoseStatus::kLargeResidual;
    if (i % 7 == 5)
      pose = {{}, std::numeric_limits<double>::quiet_NaN(), HeadPoseStatus::kTooFewReferences};
    if (i % 7 == 6)
      pose = {{}, std::numeric_limits<double>::quiet_NaN(), HeadPoseStatus::kIllConditioned};
    track.poses.push_back(pose);
  }
  return track;
}

TEST(HeadPoseCsvTest, RoundTripsToTheByte) {
  const HeadPoseTrack track = SampleTrack();
  const std::string text = WriteHeadPoseCsv(track);
  const auto read = ParseHeadPoseCsv(text, "pose.csv");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(WriteHeadPoseCsv(*read), text);
  EXPECT_EQ(read->mode, track.mode);
  EXPECT_EQ(read->rate_hz, track.rate_hz);
  EXPECT_EQ(read->first_frame, track.first_frame);
  EXPECT_EQ(read->start, track.start);
  ASSERT_EQ(read->poses.size(), track.poses.size());
  for (std::size_t i = 0; i < track.poses.size(); ++i) {
    EXPECT_EQ(read->poses[i].status, track.poses[i].status);
    EXPECT_THAT(read->poses[i].head_from_stage,
                Rigid3dNear(track.poses[i].head_from_stage, 1e-7, 0.0));
  }
}

TEST(HeadPoseCsvTest, BeginsAsDocumented) {
  HeadPoseTrack track{StabilizationMode::kNone, 60, 1, {}, {}};
  track.poses.resize(2);
  track.poses[1] = {{}, std::numeric_limits<double>::quiet_NaN(), HeadPoseStatus::kIllConditioned};
  EXPECT_EQ(WriteHeadPoseCsv(track),
            "# mode: none, rate_hz: 60\n"
            "frame,time_s,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz,residual_mm,status\n"
            "1,0.000000000,0,0,0,1,0,0,0,0,ok\n"
            "2,0.016666667,,,,,,,,,ill_conditioned\n");
}

struct BadPose {
  std::string rows;
  std::string message;
};

class BadHeadPoseCsvTest : public testing::TestWithParam<BadPose> {};

TEST_P(BadHeadPoseCsvTest, IsRefusedWithItsLine) {
  const auto read = ParseHeadPoseCsv(
      "# mode: rigid, rate_hz: 60\n"
      "frame,time_s,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz,residual_mm,status\n"
      "1,0.000000000,0,0,0,1,0,0,0,0,ok\n" +
          GetParam().rows,
      "pose.csv");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    , BadHeadPoseCsvTest,
    testing::Values(BadPose{"2,0.0166666667,0,0,0,1,0,0,0,0,ok\n", "pose.csv:4"},  // ten decimals
                    BadPose{"3,0.016666667,0,0,0,1,0,0,0,0,ok\n", "frame 3 follows frame 1"},
                    BadPose{"2,0.5,0,0,0,1,0,0,0,0,ok\n", "60 frames/s"},
                    BadPose{"2,0.016666667,0,0,0,1,1,0,0,0,ok\n", "no unit quaternion"},
                    BadPose{"2,0.016666667,0,nan,0,1,0,0,0,0,ok\n", "ty_mm is 'nan'"},
                    BadPose{"2,0.016666667,0,,0,1,0,0,0,0,ok\n", "ty_mm is ''"},
                    BadPose{"2,0.016666667,0,0,0,1,0,0,0,0,fine\n", "unknown status 'fine'"},
                    BadPose{"2,0.016666667,0,0,0,1,0,0,0,0,ill_conditioned\n",
                            "has a value although"},
                    BadPose{"2,0.016666667,0,0\n", "4 cells instead of 11"},
                    BadPose{"2,1e99,0,0,0,1,0,0,0,0,ok\n", "no time in seconds"}));

TEST(HeadPoseCsvTest, RefusesOtherFiles) {
  for (const char* text :
       {"", "\n", "frame,time_s\n", "# mode: rigid\n", "# mode: x, rate_hz: 60\n",
        "# mode: rigid, rate_hz: 0\n", "# mode: rigid, rate_hz: inf\n",
        "# mode: rigid, rate_hz: 60\n", "# mode: rigid, rate_hz: 60\na,b\n"})
    EXPECT_FALSE(ParseHeadPoseCsv(text, "pose.csv")) << text;
}

TEST(ToHeadTest, MovesWhatIsKnownAndDropsTheRest) {
  StageTracks tracks({"a", "b"}, 3, 60, 7, SessionTimeFromSeconds(1));
  for (int frame = 0; frame < 3; ++frame) tracks.Set(frame, 0, {1, 2, 3});
  tracks.Set(0, 1, {4, 5, 6}, SampleState::kFilled, 0.25F);
  HeadPoseTrack head_pose{StabilizationMode::kRigid, 60, 7, tracks.start(), {}};
  head_pose.poses.resize(3);
  head_pose.poses[0].head_from_stage = {
      Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ())), {10, 0, 0}};
  head_pose.poses[1].status = HeadPoseStatus::kTooFewReferences;
  head_pose.poses[2].status = HeadPoseStatus::kLargeResidual;

  HeadTracks expected({"a", "b"}, 3, 60, 7, SessionTimeFromSeconds(1));
  expected.Set(0, 0, {8, 1, 3});
  expected.Set(0, 1, {5, 4, 6}, SampleState::kFilled);
  expected.Set(2, 0, {1, 2, 3});
  const HeadTracks in_head = ToHead(tracks, head_pose);
  EXPECT_THAT(in_head, TracksNear(expected, 1e-12));
  EXPECT_EQ(in_head.sigma_mm(0, 1), 0.25F);
  EXPECT_EQ(in_head.first_frame(), 7);
  EXPECT_EQ(in_head.start(), tracks.start());
}

}  // namespace
}  // namespace articap
