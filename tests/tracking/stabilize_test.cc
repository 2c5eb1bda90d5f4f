// SPDX-License-Identifier: MIT
#include "tracking/stabilize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/alignment.h"
#include "tests/support/matchers.h"
#include "tests/support/report_figures.h"
#include "tests/tracking/head_scene.h"

namespace articap {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

StageResult<Stabilized> StabilizeOrDie(const StageTracks& tracks, const MarkerSet& set,
                                       const std::optional<HeadShape>& shape = std::nullopt,
                                       const StabilizeOptions& options = {}) {
  auto result = Stabilize(tracks, set, shape, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : StageResult<Stabilized>{};
}

// Every pose by its own frame alone, whose bounds are known.
StabilizeOptions FrameByFrame() {
  StabilizeOptions options;
  options.smooth_pose = false;
  return options;
}

std::string ErrorOf(const StageTracks& tracks, const MarkerSet& set,
                    const std::optional<HeadShape>& shape = std::nullopt,
                    const StabilizeOptions& options = {}) {
  const auto result = Stabilize(tracks, set, shape, options);
  EXPECT_FALSE(result) << "no error";
  return result ? "" : result.error().message;
}

int CountStatus(const HeadPoseTrack& track, HeadPoseStatus status) {
  return static_cast<int>(std::ranges::count(track.poses, status, &HeadPose::status));
}

// Root mean square errors of the poses, and what the references that were really there would allow:
// first-order least squares with the true noise and without the outliers.
struct PoseErrors {
  double rotation_rad = 0;
  double translation_mm = 0;  // at the references' centroid
  double bound_rotation_rad = 0;
  double bound_translation_mm = 0;
};

PoseErrors ErrorsOf(const HeadScene& scene, const Stabilized& stabilized, double noise_mm) {
  const Rigid3d head_from_truth = HeadFromTruth(stabilized.head_shape, scene.references);
  const Eigen::Vector3d centroid_mm = [&] {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const NamedPoint& point : scene.references.points) sum += point.point_in_head_mm;
    return Eigen::Vector3d(sum / static_cast<double>(scene.references.points.size()));
  }();
  PoseErrors sums;
  int count = 0;
  for (int frame = 0; frame < scene.tracks.num_frames(); ++frame) {
    const HeadPose& pose = stabilized.head_pose.poses[frame];
    if (!pose.is_known()) continue;
    std::vector<Eigen::Vector3d> there_mm;
    std::vector<double> weights;
    for (const NamedPoint& reference : scene.references.points) {
      const int marker = *scene.tracks.Find(reference.name);
      if (scene.tracks.is_missing(frame, marker)) continue;
      const Eigen::Vector3d in_truth_mm =
          scene.truth_from_stage[frame] * scene.tracks.position_mm(frame, marker);
      if ((in_truth_mm - reference.point_in_head_mm).norm() > 6 * noise_mm) continue;
      there_mm.push_back(reference.point_in_head_mm);
      weights.push_back(1 / (noise_mm * noise_mm));
    }
    if (there_mm.size() < 3) continue;
    const Rigid3d error =
        head_from_truth.Inverse() * pose.head_from_stage * scene.truth_from_stage[frame].Inverse();
    const double angle_rad = 2 * error.rotation.vec().norm();
    const PointSpread spread = SpreadOf(there_mm, weights);
    sums.rotation_rad += angle_rad * angle_rad;
    sums.translation_mm += (error * centroid_mm - centroid_mm).squaredNorm();
    for (int axis = 0; axis < 3; ++axis)
      sums.bound_rotation_rad += 1 / (spread.scatter.sum() - spread.scatter[axis]);
    sums.bound_translation_mm += std::pow(spread.PlacementSigma(centroid_mm), 2);
    ++count;
  }
  EXPECT_GT(count, 0);
  return {std::sqrt(sums.rotation_rad / count), std::sqrt(sums.translation_mm / count),
          std::sqrt(sums.bound_rotation_rad / count), std::sqrt(sums.bound_translation_mm / count)};
}

// 1200 frames know an RMS to 1/sqrt(2 * 3 * 1200) = 1.2 %; 5 % is four sigmas, and covers the error
// of the reference shape, 1/sqrt(1200) of a frame's.
TEST(StabilizeRigidTest, ErrorsAreWhatTheNoiseAllows) {
  const HeadScene scene = MakeHeadScene({.num_frames = 1200, .noise_mm = 0.2});
  const auto result = StabilizeOrDie(scene.tracks, scene.set, std::nullopt, FrameByFrame());
  EXPECT_EQ(CountStatus(result.output.head_pose, HeadPoseStatus::kOk), 1200);
  const PoseErrors errors = ErrorsOf(scene, result.output, 0.2);
  EXPECT_LT(errors.rotation_rad, 1.05 * errors.bound_rotation_rad);
  EXPECT_LT(errors.translation_mm, 1.05 * errors.bound_translation_mm);
  EXPECT_GT(errors.rotation_rad, 0.95 * errors.bound_rotation_rad);
  // Of 15 coordinates six are taken up by the pose: sigma sqrt(3) sqrt(9 / 15).
  EXPECT_NEAR(FigureOf(result.report, "residual_rms_mm"), 0.2 * std::sqrt(3 * 0.6), 0.01);
  EXPECT_TRUE(result.report.IsUsable());
  EXPECT_THAT(result.report.warnings, IsEmpty());
}

// Heads move slowly against the frame rate, and neighbouring frames know a good part of a pose.
TEST(StabilizeRigidTest, SmoothedPosesAreBetterThanAFrameAllows) {
  const HeadScene scene = MakeHeadScene({.num_frames = 1200, .noise_mm = 0.2});
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  const PoseErrors errors = ErrorsOf(scene, result.output, 0.2);
  EXPECT_LT(errors.rotation_rad, 0.4 * errors.bound_rotation_rad);
  EXPECT_LT(errors.translation_mm, 0.4 * errors.bound_translation_mm);
  // Per coordinate, what a frame by itself is off by.
  EXPECT_NEAR(FigureOf(result.report, "pose_noise_mm"),
              errors.bound_translation_mm / std::sqrt(3.0), 0.1 * errors.bound_translation_mm);
}

TEST(StabilizeRigidTest, WithoutNoiseThePoseIsExact) {
  const HeadScene scene = MakeHeadScene({.num_frames = 50, .noise_mm = 0});
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  const Rigid3d head_from_truth = HeadFromTruth(result.output.head_shape, scene.references);
  for (int frame = 0; frame < 50; ++frame)
    EXPECT_THAT(result.output.head_pose.poses[frame].head_from_stage,
                Rigid3dNear(head_from_truth * scene.truth_from_stage[frame], 1e-7, 1e-5));
}

// A fifth of the references missing, one in fifty 10 mm off. Where four are seen and one of these
// is off, nothing can tell which; such frames are marked by their status, and left out here.
TEST(StabilizeRigidTest, DropoutsAndOutliersCostLittle) {
  const HeadScene scene = MakeHeadScene(
      {.num_frames = 3000, .noise_mm = 0.2, .dropout = 0.2, .outliers = 0.02, .seed = 2});
  auto result = StabilizeOrDie(scene.tracks, scene.set, std::nullopt, FrameByFrame());
  EXPECT_GT(CountStatus(result.output.head_pose, HeadPoseStatus::kTooFewReferences), 0);
  for (HeadPose& pose : result.output.head_pose.poses)
    if (pose.status == HeadPoseStatus::kLargeResidual)
      pose.status = HeadPoseStatus::kTooFewReferences;
  EXPECT_LT(CountStatus(result.output.head_pose, HeadPoseStatus::kTooFewReferences), 360);
  const PoseErrors errors = ErrorsOf(scene, result.output, 0.2);
  EXPECT_LT(errors.rotation_rad, 1.15 * errors.bound_rotation_rad);
  EXPECT_LT(errors.translation_mm, 1.15 * errors.bound_translation_mm);
}

TEST(StabilizeRigidTest, ResultsAreDeterministic) {
  const HeadScene scene = MakeHeadScene({.dropout = 0.1, .outliers = 0.02});
  const auto first = StabilizeOrDie(scene.tracks, scene.set);
  const auto second = StabilizeOrDie(scene.tracks, scene.set);
  EXPECT_EQ(WriteHeadPoseCsv(first.output.head_pose), WriteHeadPoseCsv(second.output.head_pose));
  EXPECT_EQ(first.report.ToJson(), second.report.ToJson());
}

TEST(StabilizeRigidTest, HeadAxesAreAnatomical) {
  const HeadScene scene = MakeHeadScene({.noise_mm = 0});
  const HeadTracks head = StabilizeOrDie(scene.tracks, scene.set).output.tracks;
  // A frame in which the jaw hangs at its median, so that the chin is where the axes had it.
  const auto median_of = [&](const char* name, int axis) {
    std::vector<double> values;
    for (int frame = 0; frame < head.num_frames(); ++frame)
      values.push_back(head.position_mm(frame, *head.Find(name))[axis]);
    std::ranges::nth_element(values, values.begin() + std::ssize(values) / 2);
    return values[values.size() / 2];
  };
  EXPECT_THAT(head.position_mm(0, *head.Find("nose_bridge")),
              PointNear(Eigen::Vector3d(0, 0, 0), 1e-6));
  EXPECT_NEAR(median_of("chin", 0), 0, 1e-6);
  EXPECT_NEAR(median_of("chin", 2), 0, 1e-3);
  EXPECT_LT(median_of("chin", 1), -100);
  EXPECT_GT(median_of("left_mouth_corner", 0), 20);
  EXPECT_NEAR(median_of("left_mouth_corner", 1), median_of("right_mouth_corner", 1), 1e-6);
  EXPECT_GT(median_of("nose_tip", 2), 15);
}

TEST(StabilizeRigidTest, TooFewReferencesAreMarkedNotInvented) {
  HeadScene scene = MakeHeadScene({});
  for (int frame = 100; frame < 120; ++frame)
    for (int i = 1; i <= 3; ++i)
      scene.tracks.SetMissing(frame, *scene.tracks.Find("spectacles_" + std::to_string(i)));
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  for (int frame = 0; frame < 400; ++frame) {
    const HeadPose& pose = result.output.head_pose.poses[frame];
    const bool is_bad = frame >= 100 && frame < 120;
    EXPECT_EQ(pose.status, is_bad ? HeadPoseStatus::kTooFewReferences : HeadPoseStatus::kOk);
    EXPECT_EQ(std::isnan(pose.residual_mm), is_bad);
    EXPECT_EQ(result.output.tracks.is_missing(frame, *scene.tracks.Find("chin")), is_bad);
  }
  EXPECT_EQ(FigureOf(result.report, "frames_too_few_references"), 20);
}

TEST(StabilizeRigidTest, ReferencesOnALineAreIllConditioned) {
  HeadScene scene = MakeHeadScene({});
  // In some frames only two temples and a third marker on the line between them are seen.
  const int third = *scene.tracks.Find("subnasale");
  scene.set.markers[third].head_reference = true;
  for (int frame = 0; frame < 400; ++frame) {
    const Eigen::Vector3d between_mm =
        0.5 * (scene.tracks.position_mm(frame, 0) + scene.tracks.position_mm(frame, 4));
    scene.tracks.Set(frame, third, between_mm);
    if (frame % 10 == 0)
      for (const int hidden : {1, 2, 3}) scene.tracks.SetMissing(frame, hidden);
  }
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  for (int frame = 0; frame < 400; ++frame)
    EXPECT_EQ(result.output.head_pose.poses[frame].status,
              frame % 10 == 0 ? HeadPoseStatus::kIllConditioned : HeadPoseStatus::kOk);
  EXPECT_TRUE(result.output.tracks.is_missing(0, *scene.tracks.Find("chin")));
}

TEST(StabilizeRigidTest, AMovingReferenceIsNamed) {
  HeadScene scene = MakeHeadScene({});
  const int bent = *scene.tracks.Find("spectacles_5");
  for (int frame = 0; frame < 400; ++frame)
    scene.tracks.Set(
        frame, bent,
        scene.tracks.position_mm(frame, bent) + Eigen::Vector3d(0, 3 * std::sin(0.2 * frame), 0));
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  EXPECT_THAT(result.report.warnings,
              Contains(AllOf(HasSubstr("not rigid"), HasSubstr("'spectacles_5'"),
                             Not(HasSubstr("'spectacles_2'")))));
}

TEST(StabilizeRigidTest, AnotherSetIsProposedWhereTheChosenOneIsPoor) {
  const HeadScene scene = MakeHeadScene({.noise_mm = 0.3});
  StabilizeOptions options;
  options.head = {"nose_left", "nose_tip", "nose_right"};
  const auto result = StabilizeOrDie(scene.tracks, scene.set, std::nullopt, options);
  EXPECT_THAT(result.report.warnings, Contains(HasSubstr("ill-conditioned")));
  EXPECT_THAT(result.report.warnings,
              Contains(AllOf(HasSubstr("a better set"), HasSubstr("spectacles_1"),
                             HasSubstr("spectacles_5"))));
}

TEST(StabilizeRigidTest, MirroredDataAreRefusedAndMirrorHelps) {
  const HeadScene scene = MakeHeadScene({});
  for (int axis = 0; axis < 3; ++axis) {
    const StageTracks mirrored = MirrorTracks(scene.tracks, axis);
    EXPECT_THAT(ErrorOf(mirrored, scene.set), HasSubstr("--mirror"));
    EXPECT_THAT(MirrorTracks(mirrored, axis), TracksNear(scene.tracks, 0.0));
    // Mirrored back along another axis it is the same face, turned; the medians of its coordinates,
    // which the axes are built on, then differ slightly.
    const auto result = StabilizeOrDie(MirrorTracks(mirrored, (axis + 1) % 3), scene.set);
    EXPECT_THAT(result.output.tracks,
                TracksNear(StabilizeOrDie(scene.tracks, scene.set).output.tracks, 0.05));
  }
}

TEST(StabilizeRigidTest, ExchangedFaceMarkersAreNamed) {
  HeadScene scene = MakeHeadScene({});
  std::swap(scene.set.markers[*scene.tracks.Find("jaw_left")].landmark,
            scene.set.markers[*scene.tracks.Find("jaw_right")].landmark);
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  EXPECT_THAT(
      result.report.warnings,
      Contains(AllOf(HasSubstr("'jaw_left'"), HasSubstr("'jaw_right'"), HasSubstr("exchanged"))));
}

TEST(StabilizeRigidTest, ReferencesExchangedInSomeFramesAreNamed) {
  HeadScene scene = MakeHeadScene({});
  const int a = *scene.tracks.Find("spectacles_2"), b = *scene.tracks.Find("spectacles_3");
  for (int frame = 200; frame < 230; ++frame) {
    const Eigen::Vector3d point_mm = scene.tracks.position_mm(frame, a);
    scene.tracks.Set(frame, a, scene.tracks.position_mm(frame, b));
    scene.tracks.Set(frame, b, point_mm);
  }
  const auto result = StabilizeOrDie(scene.tracks, scene.set, std::nullopt, FrameByFrame());
  EXPECT_THAT(result.report.warnings,
              Contains(AllOf(HasSubstr("'spectacles_2' and 'spectacles_3' are exchanged in 30"),
                             HasSubstr("frame 201"))));
  const PoseErrors errors = ErrorsOf(scene, result.output, 0.2);
  EXPECT_LT(errors.rotation_rad, 1.2 * errors.bound_rotation_rad);
}

TEST(StabilizeRigidTest, StatedSigmasCount) {
  HeadScene scene = MakeHeadScene({.num_frames = 1000});
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const int marker = *scene.tracks.Find("spectacles_1");
  for (int frame = 0; frame < 1000; ++frame) {
    const bool is_bad = frame % 4 == 0;
    const Eigen::Vector3d extra_mm{normal(random), normal(random), normal(random)};
    for (int other = 0; other < scene.tracks.num_markers(); ++other)
      scene.tracks.Set(frame, other,
                       scene.tracks.position_mm(frame, other) +
                           (is_bad && other == marker ? extra_mm : Eigen::Vector3d::Zero().eval()),
                       SampleState::kMeasured, is_bad && other == marker ? 1.02F : 0.2F);
  }
  const PoseErrors informed = ErrorsOf(
      scene, StabilizeOrDie(scene.tracks, scene.set, std::nullopt, FrameByFrame()).output, 0.2);
  StageTracks unstated = scene.tracks;
  for (int frame = 0; frame < 1000; ++frame)
    for (int other = 0; other < unstated.num_markers(); ++other)
      unstated.Set(frame, other, unstated.position_mm(frame, other));
  const PoseErrors uninformed = ErrorsOf(
      scene, StabilizeOrDie(unstated, scene.set, std::nullopt, FrameByFrame()).output, 0.2);
  EXPECT_LT(informed.rotation_rad, 0.95 * uninformed.rotation_rad);
}

TEST(StabilizeRigidTest, FilledSamplesAreNoReferencesUnlessAllowed) {
  HeadScene scene = MakeHeadScene({});
  for (const char* name : {"spectacles_1", "spectacles_3", "spectacles_4"}) {
    const int marker = *scene.tracks.Find(name);
    scene.tracks.Set(10, marker, scene.tracks.position_mm(10, marker), SampleState::kFilled);
  }
  StabilizeOptions options;
  EXPECT_EQ(StabilizeOrDie(scene.tracks, scene.set).output.head_pose.poses[10].status,
            HeadPoseStatus::kTooFewReferences);
  options.use_filled = true;
  EXPECT_EQ(StabilizeOrDie(scene.tracks, scene.set, std::nullopt, options)
                .output.head_pose.poses[10]
                .status,
            HeadPoseStatus::kOk);
}

TEST(StabilizeRigidTest, DeclaredAxesServeWhereTheFaceIsNotMapped) {
  const HeadScene scene = MakeHeadScene({.noise_mm = 0});
  StabilizeOptions options;
  options.head = {"spectacles_1", "spectacles_2", "spectacles_3", "spectacles_4", "spectacles_5"};
  EXPECT_THAT(ErrorOf(scene.tracks, MarkerSet{}, std::nullopt, options),
              AllOf(HasSubstr("nose_bridge"), HasSubstr("--left"), HasSubstr("--shape")));
  options.left = "+z";
  options.up = "+x";
  options.forward = "+y";
  const auto result = StabilizeOrDie(scene.tracks, MarkerSet{}, std::nullopt, options);
  // On average over the take the head axes are the stage's declared ones.
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const HeadPose& pose : result.output.head_pose.poses)
    sum += pose.head_from_stage.rotation.toRotationMatrix();
  const Eigen::Matrix3d mean = BestRotation(sum).toRotationMatrix();
  EXPECT_THAT(mean * Eigen::Vector3d::UnitZ(), PointNear(Eigen::Vector3d::UnitX(), 1e-6));
  EXPECT_THAT(mean * Eigen::Vector3d::UnitX(), PointNear(Eigen::Vector3d::UnitY(), 1e-6));
}

TEST(StabilizeRigidTest, WrongUseIsNamed) {
  const HeadScene scene = MakeHeadScene({.num_frames = 30});
  StabilizeOptions options;
  options.head = {"chin", "nose"};
  EXPECT_THAT(ErrorOf(scene.tracks, scene.set, std::nullopt, options),
              HasSubstr("no marker 'nose'"));
  options.head = {"chin", "nose_tip"};
  EXPECT_THAT(ErrorOf(scene.tracks, scene.set, std::nullopt, options),
              HasSubstr("three references or more"));
  options.head = {"chin", "nose_tip", "chin"};
  EXPECT_THAT(ErrorOf(scene.tracks, scene.set, std::nullopt, options), HasSubstr("twice"));
  options = {};
  options.max_residual_mm = -1;
  EXPECT_THAT(ErrorOf(scene.tracks, scene.set, std::nullopt, options),
              HasSubstr("max_residual_mm is -1"));
  options = {};
  options.left = "+x";
  EXPECT_THAT(ErrorOf(scene.tracks, scene.set, std::nullopt, options), HasSubstr("all three"));
  EXPECT_THAT(ErrorOf(StageTracks({"a"}, 0, 60), scene.set), HasSubstr("no frames"));
  StageTracks unseen = scene.tracks;
  for (int frame = 0; frame < 30; ++frame)
    for (int i = 0; i < 3; ++i) unseen.SetMissing(frame, i);
  EXPECT_THAT(ErrorOf(unseen, scene.set), HasSubstr("no frame shows three of the references"));
}

TEST(StabilizeRigidTest, AMarkerLostFromTheTakeIsNamed) {
  HeadScene scene = MakeHeadScene({});
  scene.set.markers.push_back({.name = "spectacles_6", .head_reference = true});
  for (int frame = 0; frame < 400; ++frame)
    scene.tracks.SetMissing(frame, *scene.tracks.Find("spectacles_4"));
  const auto result = StabilizeOrDie(scene.tracks, scene.set);
  EXPECT_EQ(CountStatus(result.output.head_pose, HeadPoseStatus::kOk), 400);
  EXPECT_THAT(result.report.warnings,
              Contains(AllOf(HasSubstr("'spectacles_6'"), HasSubstr("not in the take"))));
  EXPECT_THAT(result.report.warnings,
              Contains(AllOf(HasSubstr("'spectacles_4'"), HasSubstr("never seen"))));
}

// ---- A given shape

TEST(StabilizeWithShapeTest, ItsFrameIsTheHeadFrame) {
  const HeadScene scene = MakeHeadScene({.noise_mm = 0});
  const auto result = StabilizeOrDie(scene.tracks, scene.set, scene.references);
  for (int frame = 0; frame < 400; frame += 37)
    EXPECT_THAT(result.output.head_pose.poses[frame].head_from_stage,
                Rigid3dNear(scene.truth_from_stage[frame], 1e-7, 1e-5));
  EXPECT_EQ(WriteHeadShapeCsv(result.output.head_shape), WriteHeadShapeCsv(scene.references));
  EXPECT_THAT(result.report.warnings, IsEmpty());
}

TEST(StabilizeWithShapeTest, TwoTakesAgree) {
  const HeadScene first = MakeHeadScene({.seed = 1}), second = MakeHeadScene({.seed = 2});
  const HeadShape shape = StabilizeOrDie(first.tracks, first.set).output.head_shape;
  const auto again = StabilizeOrDie(second.tracks, second.set, shape);
  EXPECT_THAT(HeadFromTruth(again.output.head_shape, first.references),
              Rigid3dNear(HeadFromTruth(shape, first.references), 1e-9, 1e-9));
}

TEST(StabilizeWithShapeTest, AReGluedMarkerIsNamedAndLeftOut) {
  HeadScene scene = MakeHeadScene({.num_frames = 1000});
  HeadShape shape = scene.references;
  shape.points[1].point_in_head_mm += Eigen::Vector3d(0, 4, 0);
  const auto result = StabilizeOrDie(scene.tracks, scene.set, shape, FrameByFrame());
  EXPECT_THAT(result.report.warnings,
              Contains(AllOf(HasSubstr("'spectacles_2' lies"), HasSubstr("left out"))));
  EXPECT_EQ(result.output.head_shape.Find("spectacles_2"), nullptr);
  HeadScene without = scene;
  without.references.points.erase(without.references.points.begin() + 1);
  const PoseErrors errors = ErrorsOf(without, result.output, 0.2);
  EXPECT_LT(errors.rotation_rad, 1.06 * errors.bound_rotation_rad);
}

TEST(StabilizeWithShapeTest, ExchangedReferencesAreNamed) {
  const HeadScene scene = MakeHeadScene({});
  HeadShape shape = scene.references;
  std::swap(shape.points[1].name, shape.points[3].name);
  EXPECT_THAT(
      ErrorOf(scene.tracks, scene.set, shape),
      AllOf(HasSubstr("exchanged"), HasSubstr("'spectacles_2' is where 'spectacles_4' should be"),
            HasSubstr("'spectacles_4' is where 'spectacles_2' should be")));
}

TEST(StabilizeWithShapeTest, SpectaclesSeatedAnewAreFoundByWitnesses) {
  const HeadScene scene = MakeHeadScene({.noise_mm = 0});
  HeadShape shape = scene.references;
  // sqrt(5^2 + 3^2) = 5.83 mm.
  for (NamedPoint& point : shape.points) point.point_in_head_mm += Eigen::Vector3d(0, 5, 3);
  for (const char* name : {"nose_bridge", "left_brow_inner", "right_brow_outer"}) {
    const HeadScene& truth = scene;
    const int marker = *truth.tracks.Find(name);
    shape.points.push_back({name, truth.truth_from_stage[0] * truth.tracks.position_mm(0, marker)});
  }
  EXPECT_THAT(StabilizeOrDie(scene.tracks, scene.set, shape).report.warnings,
              Contains(AllOf(HasSubstr("seated anew"), HasSubstr("'nose_bridge' 5.8 mm"))));
}

TEST(StabilizeWithShapeTest, WorksWithoutAMap) {
  const HeadScene scene = MakeHeadScene({.noise_mm = 0});
  const auto result = StabilizeOrDie(scene.tracks, MarkerSet{}, scene.references);
  EXPECT_THAT(result.output.head_pose.poses[7].head_from_stage,
              Rigid3dNear(scene.truth_from_stage[7], 1e-7, 1e-5));
}

// ---- The declared modes

MarkerSet DeclaredSet(StabilizationMode mode) {
  MarkerSet set = SpectaclesSet();
  set.mode = mode;
  for (MarkerRole& marker : set.markers) marker.head_reference = marker.name == "nose_tip";
  set.axes =
      DeclaredAxes{Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()};
  return set;
}

// The face at rest in a stage with x forward, y to the left, z up.
StageTracks TracksWithXForward(int num_frames) {
  const HeadScene scene = MakeHeadScene({.num_frames = num_frames, .noise_mm = 0.1});
  StageTracks tracks(scene.tracks.names(), num_frames, 60);
  for (int frame = 0; frame < num_frames; ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      const Eigen::Vector3d p =
          scene.truth_from_stage[frame] * scene.tracks.position_mm(frame, marker);
      tracks.Set(frame, marker, {p.z() + 0.1 * frame, p.x(), p.y()});
    }
  return tracks;
}

TEST(StabilizeTranslationTest, TheReferenceIsTheOrigin) {
  StageTracks tracks = TracksWithXForward(100);
  const int nose = *tracks.Find("nose_tip"), chin = *tracks.Find("chin");
  tracks.SetMissing(5, nose);
  const auto result = StabilizeOrDie(tracks, DeclaredSet(StabilizationMode::kTranslation));
  EXPECT_EQ(result.output.head_pose.mode, StabilizationMode::kTranslation);
  for (int frame = 0; frame < 100; ++frame) {
    if (frame == 5) continue;
    EXPECT_THAT(result.output.tracks.position_mm(frame, nose),
                PointNear(Eigen::Vector3d(0, 0, 0), 1e-9));
    const Eigen::Vector3d offset_mm =
        tracks.position_mm(frame, chin) - tracks.position_mm(frame, nose);
    EXPECT_THAT(result.output.tracks.position_mm(frame, chin),
                PointNear(Eigen::Vector3d(offset_mm.y(), offset_mm.z(), offset_mm.x()), 1e-9));
  }
  EXPECT_EQ(result.output.head_pose.poses[5].status, HeadPoseStatus::kTooFewReferences);
  EXPECT_TRUE(result.output.tracks.is_missing(5, chin));
  EXPECT_THAT(result.report.warnings, Contains(HasSubstr("declared, not measured")));
}

TEST(StabilizeTranslationTest, TakesExactlyOneReference) {
  MarkerSet set = SpectaclesSet();
  set.mode = StabilizationMode::kTranslation;
  EXPECT_THAT(ErrorOf(MakeHeadScene({.num_frames = 5}).tracks, set),
              HasSubstr("exactly one reference"));
}

TEST(StabilizeNoneTest, OnlyTheAxesAreApplied) {
  const StageTracks tracks = TracksWithXForward(50);
  const auto result = StabilizeOrDie(tracks, DeclaredSet(StabilizationMode::kNone));
  for (int frame = 0; frame < 50; ++frame)
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      const Eigen::Vector3d& p = tracks.position_mm(frame, marker);
      EXPECT_THAT(result.output.tracks.position_mm(frame, marker),
                  PointNear(Eigen::Vector3d(p.y(), p.z(), p.x()), 1e-9));
    }
  EXPECT_TRUE(result.output.head_shape.points.empty());
  EXPECT_THAT(result.report.warnings, IsEmpty());
}

TEST(StabilizeNoneTest, AxesThatContradictTheFaceAreNamed) {
  const StageTracks tracks = TracksWithXForward(50);
  MarkerSet set = DeclaredSet(StabilizationMode::kNone);
  set.axes.reset();
  EXPECT_THAT(StabilizeOrDie(tracks, set).report.warnings,
              Contains(HasSubstr("degrees off the axes")));
  EXPECT_THAT(ErrorOf(MirrorTracks(tracks, 1), DeclaredSet(StabilizationMode::kNone)),
              HasSubstr("--mirror"));
}

TEST(StabilizeOptionsTest, EchoNamesEveryField) {
  const auto echo = EchoOptions(StabilizeOptions{});
  EXPECT_THAT(echo, Contains(testing::Pair("mode", "map")));
  EXPECT_THAT(echo, Contains(testing::Pair("max_rotation_sigma_deg", "1.5")));
  EXPECT_EQ(echo.size(), 16u);
}

}  // namespace
}  // namespace articap
