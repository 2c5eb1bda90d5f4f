// SPDX-License-Identifier: MIT
#include "fitting/bind.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/reference_pose.h"
#include "rig/virtual_marker_evaluator.h"
#include "tests/support/matchers.h"
#include "tests/support/result.h"
#include "tests/support/spoken_take.h"

namespace articap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A speaker of another shape and size than the default head.
const SpokenTake& Speaker() {
  static const SpokenTake spoken = MakeSpokenTake({.seed = 4});
  return spoken;
}

StageResult<Binding> BindSpeaker(const BindOptions& options) {
  return OrThrow(Bind(Speaker().tracks, {}, Speaker().take.marker_set, DefaultHead(), options));
}

// "so that the error in the reference pose is exactly zero" (Beskow): whatever the pose and the
// identity, and however badly the head fits the rig.
TEST(BindTest, TheReferencePoseIsMetExactly) {
  for (const std::vector<std::string>& pose :
       {std::vector<std::string>{}, {"jaw_rotation=4deg", "lip_rounding=1mm"}}) {
    BindOptions options;
    options.frames = "1:30";
    options.pose = pose;
    const Binding binding = BindSpeaker(options).output;
    const FaceRig rig = OrThrow(RigOfBinding(binding, DefaultHead()));
    const Eigen::VectorXd y = OrThrow(ReferenceParameters(binding, DefaultHead()));
    const VirtualMarkerEvaluator evaluator(rig, binding.virtual_markers);
    const Eigen::Matrix3Xd q = evaluator.Positions({y.data(), static_cast<std::size_t>(y.size())});
    ASSERT_EQ(q.cols(), 30);
    for (Eigen::Index i = 0; i < q.cols(); ++i) {
      const NamedPoint* point = binding.reference_pose.Find(binding.virtual_markers[i].name);
      EXPECT_THAT(Eigen::Vector3d(q.col(i)),
                  PointNear(binding.rig_from_head * point->point_in_head_mm, 1e-9))
          << point->name;
    }
  }
}

TEST(BindTest, TheSpeakersSizeIsFound) {
  BindOptions options;
  options.frames = "1:30";
  const auto bound = BindSpeaker(options);
  EXPECT_TRUE(bound.report.usable);
  EXPECT_NEAR(bound.output.rig_from_head.scale, Speaker().take.rig_from_head.scale, 0.02);
}

TEST(BindTest, SlidersGivenByHandAreKept) {
  BindOptions options;
  options.frames = "1:30";
  options.identity = {"lip_thickness=0.2"};
  const Binding binding = BindSpeaker(options).output;
  const auto slider = std::ranges::find(binding.rig_identity, "lip_thickness", &NamedValue::name);
  ASSERT_NE(slider, binding.rig_identity.end());
  EXPECT_EQ(slider->value, 0.2);
}

TEST(BindTest, UnknownSlidersAndParametersFail) {
  BindOptions options;
  options.identity = {"ear_size=0.2"};
  auto bound = Bind(Speaker().tracks, {}, Speaker().take.marker_set, DefaultHead(), options);
  ASSERT_FALSE(bound);
  EXPECT_THAT(bound.error().message, HasSubstr("ear_size"));
  options = {};
  options.pose = {"jaw_rotation=4mm"};
  bound = Bind(Speaker().tracks, {}, Speaker().take.marker_set, DefaultHead(), options);
  ASSERT_FALSE(bound);
  EXPECT_THAT(bound.error().message, HasSubstr("jaw_rotation"));
}

TEST(BindTest, ABindingForAnotherRigFails) {
  Binding binding;
  binding.rig_identity = {{"ear_size", 0.1}};
  EXPECT_THAT(RigOfBinding(binding, DefaultHead()).error().message, HasSubstr("ear_size"));
  binding.rig_parameters = {{"ear_wiggle", 0.1}};
  EXPECT_THAT(ReferenceParameters(binding, DefaultHead()).error().message, HasSubstr("ear_wiggle"));
}

TEST(FrameRangeTest, CountsByTheRecordingsNumbers) {
  const FrameRange range = OrThrow(ParseFrameRange("110:119", 101, 50));
  EXPECT_EQ(range.first, 110);
  EXPECT_EQ(range.size(), 10);
  EXPECT_EQ(OrThrow(ParseFrameRange("150", 101, 50)).size(), 1);
  for (const char* wrong : {"100:110", "140:151", "119:110", "1-5", "", ":", "1:", "x:3"})
    EXPECT_FALSE(ParseFrameRange(wrong, 101, 50)) << wrong;
}

// Before its first sentence the synthetic speaker is at rest; a proposal must find such frames,
// which it does where the truth's parameters are near zero.
TEST(ReferencePoseTest, ProposesFramesAtRest) {
  const FrameRange frames =
      OrThrow(ProposeReferenceFrames(Speaker().tracks, Speaker().take.marker_set, 40));
  EXPECT_GE(frames.size(), 10);
  const ParameterTrack& truth = Speaker().take.truth;
  for (int frame = frames.first - 1; frame < frames.last; ++frame)
    for (int k = 0; k < truth.num_parameters(); ++k) {
      const RigParameter& range = DefaultHead().definition().parameters[k];
      EXPECT_LT(std::abs(truth.values(frame, k)), 0.05 * (range.max - range.min))
          << truth.names[k] << ", frame " << frame;
    }
}

TEST(ReferencePoseTest, AveragesWhatIsSeen) {
  HeadTracks tracks({"still", "moving", "rare"}, 4, 60);
  for (int frame = 0; frame < 4; ++frame) {
    tracks.Set(frame, 0, {1, 2, 3});
    if (frame != 1) tracks.Set(frame, 1, {3.0 * frame, 0, 0});
  }
  tracks.Set(0, 2, {5, 5, 5});
  const AveragedPose averaged = AverageFrames(tracks, {1, 4});
  EXPECT_THAT(averaged.left_out, ElementsAre("rare"));
  ASSERT_EQ(averaged.pose.points.size(), 2u);
  EXPECT_THAT(averaged.pose.points[0].point_in_head_mm, PointNear(Eigen::Vector3d(1, 2, 3), 1e-12));
  EXPECT_THAT(averaged.pose.points[1].point_in_head_mm, PointNear(Eigen::Vector3d(5, 0, 0), 1e-12));
  EXPECT_GT(averaged.largest_sd_mm, 3);
}

}  // namespace
}  // namespace articap
