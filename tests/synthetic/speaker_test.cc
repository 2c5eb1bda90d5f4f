// SPDX-License-Identifier: MIT
#include "synthetic/speaker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/mesh.h"
#include "tests/support/matchers.h"
#include "tests/synthetic/patch_face.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

SyntheticTakeOptions OneSentence(int seed) {
  SyntheticTakeOptions options;
  options.seed = seed;
  options.speech.num_sentences = 1;
  return options;
}

SyntheticTake Take(const SyntheticTakeOptions& options) {
  return SynthesizeTake(MakePatchFace(), PatchFaceMarkers(), options).value();
}

TEST(SynthesizeTakeTest, SameSeedSameMarkersOtherSeedOthers) {
  const SyntheticTake a = Take(OneSentence(1)), b = Take(OneSentence(1)), c = Take(OneSentence(2));
  ASSERT_EQ(a.markers.tracks.num_frames(), b.markers.tracks.num_frames());
  for (int frame = 0; frame < a.markers.tracks.num_frames(); ++frame)
    for (int marker = 0; marker < a.markers.tracks.num_markers(); ++marker)
      ASSERT_EQ(a.markers.tracks.position_mm(frame, marker),
                b.markers.tracks.position_mm(frame, marker));
  EXPECT_NE(a.markers.tracks.position_mm(0, 0), c.markers.tracks.position_mm(0, 0));
  EXPECT_NE(a.identity_values(), c.identity_values());
}

// q of an attachment on a posed mesh, straight from its definition.
Eigen::Vector3d ByDefinition(const FaceRig& rig, const VirtualMarker& marker,
                             const Eigen::VectorXd& parameters) {
  const TriangleMesh posed{rig.Evaluate(parameters), rig.neutral_mesh().triangles};
  const Eigen::Vector3d& v1 = posed.vertices[marker.triangle[0]];
  return v1 + marker.s * (posed.vertices[marker.triangle[1]] - v1) +
         marker.t * (posed.vertices[marker.triangle[2]] - v1) +
         marker.u_mm * VertexNormals(posed)[marker.triangle[0]];
}

TEST(SynthesizeTakeTest, TruthExplainsTheMarkers) {
  SyntheticTakeOptions options = OneSentence(3);
  options.speaker_scale = 1.06;
  const SyntheticTake take = Take(options);
  const FaceRig speaker = MakePatchFace().WithIdentity(take.identity_values());
  for (int frame = 0; frame < take.truth.num_frames(); frame += 10)
    for (int marker = 0; marker < take.markers.tracks.num_markers(); ++marker) {
      const Eigen::Vector3d point_in_head = take.true_pose.poses[frame].head_from_stage *
                                            take.markers.tracks.position_mm(frame, marker);
      ASSERT_THAT(take.rig_from_head * point_in_head,
                  PointNear(ByDefinition(speaker, take.true_attachments[marker],
                                         take.truth.values.row(frame)),
                            1e-9));
    }
}

TEST(SynthesizeTakeTest, SpectaclesAreRigidAndTheFaceIsNot) {
  const SyntheticTake take = Take(OneSentence(4));
  const StageTracks& tracks = take.markers.tracks;
  const auto distance = [&](int frame, const char* a, const char* b) {
    return (tracks.position_mm(frame, *tracks.Find(a)) - tracks.position_mm(frame, *tracks.Find(b)))
        .norm();
  };
  double largest_change_mm = 0;
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    EXPECT_NEAR(distance(frame, "s1", "s2"), distance(0, "s1", "s2"), 1e-9);
    EXPECT_NEAR(distance(frame, "s2", "s3"), distance(0, "s2", "s3"), 1e-9);
    largest_change_mm = std::max(
        largest_change_mm, std::abs(distance(frame, "s1", "chin") - distance(0, "s1", "chin")));
  }
  EXPECT_GT(largest_change_mm, 5);
}

TEST(SynthesizeTakeTest, MarkersSitAtTheirLandmarksAboveTheSkin) {
  SyntheticTakeOptions options = OneSentence(5);
  options.misplacement_mm = 0;
  const SyntheticTake exact = Take(options);
  options.misplacement_mm = 3;
  const SyntheticTake loose = Take(options);
  const FaceRig speaker = MakePatchFace().WithIdentity(exact.identity_values());
  const Eigen::VectorXd neutral = Eigen::VectorXd::Zero(speaker.num_parameters());
  double largest_mm = 0;
  for (std::size_t i = 0; i < exact.true_attachments.size(); ++i) {
    const MarkerRole& role = exact.marker_set.markers[i];
    const Eigen::Vector3d landmark =
        speaker.neutral_mesh().vertices[*speaker.FindLandmark(role.landmark)];
    EXPECT_NEAR((ByDefinition(speaker, exact.true_attachments[i], neutral) - landmark).norm(),
                role.offset_mm, 1e-9);
    VirtualMarker on_skin = loose.true_attachments[i];
    EXPECT_EQ(on_skin.u_mm, role.offset_mm);
    on_skin.u_mm = 0;
    const double beside_mm = (ByDefinition(speaker, on_skin, neutral) - landmark).norm();
    EXPECT_LE(beside_mm, 3);
    largest_mm = std::max(largest_mm, beside_mm);
  }
  EXPECT_GT(largest_mm, 1);
}

TEST(SynthesizeTakeTest, TheHeadMovesWithinItsLimits) {
  SyntheticTakeOptions options = OneSentence(6);
  options.speech.num_sentences = 20;
  const SyntheticTake take = Take(options);
  options.head.max_rotation_deg = 0;
  options.head.max_translation_mm = 0;
  const Rigid3d mean_from_stage = Take(options).true_pose.poses[0].head_from_stage;
  double largest_angle = 0;
  for (const HeadPose& pose : take.true_pose.poses)
    largest_angle = std::max(
        largest_angle, pose.head_from_stage.rotation.angularDistance(mean_from_stage.rotation));
  EXPECT_LE(largest_angle, 15 * std::numbers::pi / 180);
  EXPECT_GE(largest_angle, 7 * std::numbers::pi / 180);
}

TEST(SynthesizeTakeTest, IdentitySlidersTakeEffect) {
  SyntheticTakeOptions options = OneSentence(7);
  options.misplacement_mm = 0;
  const auto mouth_width = [&](const char* identity) {
    options.identity = {identity};
    const StageTracks tracks = Take(options).markers.tracks;
    return (tracks.position_mm(0, *tracks.Find("left_mouth_corner")) -
            tracks.position_mm(0, *tracks.Find("right_mouth_corner")))
        .norm();
  };
  EXPECT_NEAR(mouth_width("face_width=1") / mouth_width("face_width=0"), 1.1, 0.01);
}

TEST(SynthesizeTakeTest, RefusesWhatItCannotDoAndSaysWhy) {
  const FaceRig rig = MakePatchFace();
  SyntheticTakeOptions options;
  options.identity = {"nose_length=1"};
  EXPECT_THAT(SynthesizeTake(rig, PatchFaceMarkers(), options).error().message,
              AllOf(HasSubstr("nose_length"), HasSubstr("face_width")));
  options.identity = {"face_width=two"};
  EXPECT_THAT(SynthesizeTake(rig, PatchFaceMarkers(), options).error().message,
              HasSubstr("name=value"));
  options.identity = {"face_width=7"};
  EXPECT_THAT(SynthesizeTake(rig, PatchFaceMarkers(), options).error().message,
              HasSubstr("range -1 to 1"));
  options.identity.clear();
  options.speech.rate_hz = 0;
  EXPECT_THAT(SynthesizeTake(rig, PatchFaceMarkers(), options).error().message,
              HasSubstr("rate_hz"));
  options.speech.rate_hz = 60;
  MarkerSet set = PatchFaceMarkers();
  set.markers[4].landmark = "third_eye";
  EXPECT_THAT(SynthesizeTake(rig, set, options).error().message,
              AllOf(HasSubstr("third_eye"), HasSubstr(set.markers[4].name)));
}

}  // namespace
}  // namespace articap
