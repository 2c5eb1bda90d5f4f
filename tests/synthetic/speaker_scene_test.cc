// SPDX-License-Identifier: MIT
#include "synthetic/speaker_scene.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/traced_scene.h"
#include "rig/default_head/default_head.h"
#include "tests/support/matchers.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

const FaceRig& Head() {
  static const FaceRig head = OrThrow(MakeDefaultHead());
  return head;
}

MarkerSet MapOf(const std::string& name) {
  return OrThrow(ReadMarkerSet(SourceFolder() / "maps" / (name + ".toml")));
}

FilmedSpeaker SpeakerWith(const std::string& map, const SpeakerLookOptions& look) {
  SyntheticTakeOptions options;
  options.speaker_ahead = true;
  options.speech.num_sentences = 1;
  options.speech.rest_s = 0.2;
  options.speech.rate_hz = 25;
  options.head.max_rotation_deg = 10;
  options.head.max_translation_mm = 10;
  return FilmedSpeaker(Head(), OrThrow(SynthesizeTake(Head(), WithDots(MapOf(map), look), options)),
                       look);
}

SpeakerLookOptions Look(DotKind dots) {
  SpeakerLookOptions look;
  look.dots = dots;
  look.diffuse_light = 1;
  return look;
}

// The same scene with dots of another colour.
SpeakerScene WithDotsOf(SpeakerScene filmed, float color) {
  for (RenderDisc& disc : filmed.scene.discs) disc.color.setConstant(color);
  for (RenderSphere& sphere : filmed.scene.spheres) sphere.color.setConstant(color);
  return filmed;
}

// How much of each pixel is covered by dots: what changes with their colour.
class Coverage {
 public:
  Coverage(const Studio& studio, const SpeakerScene& filmed, int camera)
      : width_(studio.lens_view(camera).width()) {
    const PictureRows all = {0, studio.lens_view(camera).height()};
    white_ = RenderSpeaker(studio, WithDotsOf(filmed, 1), camera, all);
    black_ = RenderSpeaker(studio, WithDotsOf(filmed, 0), camera, all);
  }

  struct Blob {
    double area_px2 = 0;
    Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  };
  // In a square around a place, of a dot as bright as `light`.
  Blob Near(const Eigen::Vector2d& near_px, double reach_px, double light) const {
    Blob blob;
    for (int y = static_cast<int>(near_px.y() - reach_px); y <= near_px.y() + reach_px; ++y)
      for (int x = static_cast<int>(near_px.x() - reach_px); x <= near_px.x() + reach_px; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * width_ + x;
        const double covered = (white_.rgb[pixel].x() - black_.rgb[pixel].x()) / light;
        blob.area_px2 += covered;
        blob.center_px += covered * Eigen::Vector2d(x, y);
      }
    blob.center_px /= blob.area_px2;
    return blob;
  }
  double BrightestNear(const Eigen::Vector2d& near_px) const {
    const auto pixel = static_cast<std::size_t>(std::lround(near_px.y())) * width_ +
                       static_cast<std::size_t>(std::lround(near_px.x()));
    return white_.rgb[pixel].x() - black_.rgb[pixel].x();
  }

 private:
  int width_;
  LinearPicture white_, black_;
};

struct TruthErrors {
  double sum_square_px2 = 0;
  double largest_px = 0;
  double largest_part = 0;  // of the area
  int count = 0;
};

// Dots that are whole, against what the picture shows of them.
TruthErrors CompareWithPictures(const Studio& studio, const FilmedSpeaker& speaker) {
  TruthErrors errors;
  for (const double frame : {3.0, 61.5}) {
    const SpeakerScene filmed = speaker.At(frame, studio);
    const auto truths = TruthOfDots(studio, filmed);
    const std::vector<View> views = studio.cameras().array.views();
    for (int camera = 0; camera < studio.num_cameras(); ++camera) {
      const Coverage coverage(studio, filmed, camera);
      for (std::size_t view = 0; view < views.size(); ++view)
        for (const DotTruth& truth : truths[view]) {
          if (views[view].camera != camera || truth.visible < 1) continue;
          const double reach_px = truth.diameter_px / 2 + 3;
          const Coverage::Blob blob =
              coverage.Near(truth.center_px, reach_px, coverage.BrightestNear(truth.center_px));
          const double error_px = (blob.center_px - truth.center_px).norm();
          const double area_px2 = std::numbers::pi / 4 * truth.diameter_px * truth.diameter_px;
          errors.sum_square_px2 += error_px * error_px;
          errors.largest_px = std::max(errors.largest_px, error_px);
          errors.largest_part =
              std::max(errors.largest_part, std::abs(blob.area_px2 / area_px2 - 1));
          ++errors.count;
        }
    }
  }
  return errors;
}

// 144 samples leave half a hundredth of a pixel's area in each pixel of an edge, 0.002 px of the
// centre of a dot of 10 px; perspective moves the middle of a sticker's outline off its centre's
// image by up to f r^2 / (2 d^2) = 0.0073 px. Measured: balls 0.004, stickers 0.009 px RMS. Hidden
// less than a hundredth counts as whole: 0.02 px where the edge is cut.
TEST(SpeakerSceneTest, DotsAppearWhereTheTruthHasThem) {
  const Studio mirror(MirrorSetUp(4, 1));
  for (const DotKind dots : {DotKind::kBall, DotKind::kDisc}) {
    const TruthErrors errors = CompareWithPictures(mirror, SpeakerWith("mirror6", Look(dots)));
    EXPECT_GE(errors.count, 12);
    EXPECT_LT(std::sqrt(errors.sum_square_px2 / errors.count), 0.01) << static_cast<int>(dots);
    EXPECT_LT(errors.largest_px, 0.025) << static_cast<int>(dots);
    EXPECT_LT(errors.largest_part, 0.02) << static_cast<int>(dots);
  }
}

TEST(SpeakerSceneTest, MarkersAreWhereTheTakeHasThem) {
  const Studio studio(RingOfCameras(1, 1, {64, 48, 100}));
  for (const DotKind dots : {DotKind::kBall, DotKind::kDisc}) {
    const FilmedSpeaker speaker = SpeakerWith("spectacles30", Look(dots));
    const StageTracks& tracks = speaker.take().markers.tracks;
    for (int frame = 0; frame < tracks.num_frames(); frame += 11) {
      const SpeakerScene filmed = speaker.At(frame, studio);
      ASSERT_EQ(filmed.num_dots, 35);
      for (int dot = 0; dot < filmed.num_dots; ++dot)
        EXPECT_THAT(filmed.center_mm(dot), PointNear(tracks.position_mm(frame, dot), 1e-9));
    }
  }
}

// Between frames dots move on smoothly: halfway they are halfway, but for what acceleration does.
TEST(SpeakerSceneTest, BetweenFramesDotsAreBetween) {
  const Studio studio(RingOfCameras(1, 1, {64, 48, 100}));
  const FilmedSpeaker speaker = SpeakerWith("mirror6", Look(DotKind::kBall));
  const StageTracks& tracks = speaker.take().markers.tracks;
  for (int frame = 1; frame + 2 < tracks.num_frames(); frame += 7) {
    const SpeakerScene filmed = speaker.At(frame + 0.5, studio);
    for (int dot = 0; dot < filmed.num_dots; ++dot) {
      const Eigen::Vector3d middle_mm =
          (tracks.position_mm(frame, dot) + tracks.position_mm(frame + 1, dot)) / 2;
      const Eigen::Vector3d bend_mm =
          tracks.position_mm(frame - 1, dot) - tracks.position_mm(frame, dot) -
          tracks.position_mm(frame + 1, dot) + tracks.position_mm(frame + 2, dot);
      // Catmull and Rom: 9/16 of the inner two less 1/16 of the outer two.
      EXPECT_THAT(filmed.center_mm(dot), PointNear(middle_mm - bend_mm / 16, 0.02));
    }
  }
}

// Looked at from straight above, a sticker's edge is seen all around, through a whole sentence:
// skin does not rise through it, but where it is steep, beside the nose or on the hinge of
// spectacles.
TEST(SpeakerSceneTest, StickersAreNeverSunk) {
  const Studio studio(RingOfCameras(1, 1, {64, 48, 100}));
  const FilmedSpeaker speaker = SpeakerWith("spectacles30", Look(DotKind::kDisc));
  for (int frame = 0; frame < speaker.take().truth.num_frames(); frame += 10) {
    const SpeakerScene filmed = speaker.At(frame, studio);
    const TracedScene traced(filmed.scene);
    for (const RenderDisc& disc : filmed.scene.discs) {
      int seen = 0;
      for (int i = 0; i < 16; ++i) {
        const Eigen::Vector3d out =
            Eigen::AngleAxisd(i * std::numbers::pi / 8, disc.normal) * disc.normal.unitOrthogonal();
        const SightRay ray{disc.center_mm + 0.95 * disc.radius_mm * out + 6 * disc.normal,
                           -disc.normal};
        const SightEnd end = traced.Follow(ray);
        seen += end.surface && end.surface->disc >= 0;
      }
      EXPECT_GE(seen, 12) << "frame " << frame << ", sticker " << &disc - filmed.scene.discs.data();
    }
  }
}

TEST(SpeakerSceneTest, TheHeadHidesDotsAndEdgesOfMirrorsDo) {
  const Studio studio(MirrorSetUp(4, 1));
  const SpeakerScene filmed = SpeakerWith("mirror6", Look(DotKind::kBall)).At(0, studio);
  const auto truths = TruthOfDots(studio, filmed);
  ASSERT_EQ(truths.size(), 2u);
  for (const DotTruth& truth : truths[0]) EXPECT_GT(truth.visible, 0.95) << "from the front";
  const int left_corner = 4, right_corner = 5;
  EXPECT_GT(truths[1][left_corner].visible, 0.95);
  EXPECT_EQ(truths[1][right_corner].visible, 0) << "the far mouth corner";
}

TEST(SpeakerSceneTest, AHiddenPartIsMissingInThePicture) {
  const Studio studio(MirrorSetUp(4, 1));
  const FilmedSpeaker speaker = SpeakerWith("mirror6", Look(DotKind::kBall));
  int partly_seen = 0;
  for (const double frame : {0.0, 30.0}) {
    const SpeakerScene filmed = speaker.At(frame, studio);
    const Coverage coverage(studio, filmed, 0);
    const auto truths = TruthOfDots(studio, filmed);
    for (const DotTruth& truth : truths[1]) {
      if (truth.visible >= 1 || truth.visible < 0.5) continue;
      ++partly_seen;
      // Seen in a mirror: of unit light what that reflects is left.
      const double light = 0.92 * filmed.scene.ambient.x();
      const Coverage::Blob blob = coverage.Near(truth.center_px, truth.diameter_px / 2 + 1, light);
      const double area_px2 = std::numbers::pi / 4 * truth.diameter_px * truth.diameter_px;
      EXPECT_NEAR(blob.area_px2 / area_px2, truth.visible, 0.03);
    }
  }
  EXPECT_GT(partly_seen, 3);
}

// The brightest pixel of what wetness adds to a picture, near a place.
Eigen::Vector2d BrightestAdded(const LinearPicture& wet, const LinearPicture& dry,
                               const Eigen::Vector2d& near_px) {
  constexpr int kReach_px = 12;
  Eigen::Vector2d brightest_px = near_px;
  float most = 0;
  for (int y = static_cast<int>(near_px.y()) - kReach_px; y <= near_px.y() + kReach_px; ++y)
    for (int x = static_cast<int>(near_px.x()) - kReach_px; x <= near_px.x() + kReach_px; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * wet.width + x;
      const float added = wet.rgb[pixel].x() - dry.rgb[pixel].x();
      if (added <= most) continue;
      most = added;
      brightest_px = {x, y};
    }
  return brightest_px;
}

// To a pixel, and to the tenth of a triangle's edge by which the truth is sought.
TEST(SpeakerSceneTest, GlintsAreWhereTheTruthHasThem) {
  SpeakerLookOptions look;
  look.glints = true;
  const Studio studio(RingOfCameras(2, 1));
  const FilmedSpeaker speaker = SpeakerWith("mirror6", look);
  const PictureRows all = {0, 720};
  int seen = 0;
  for (const double frame : {0.0, 60.0}) {
    const SpeakerScene wet = speaker.At(frame, studio);
    SpeakerScene dry = wet;
    dry.scene.wet_spots.clear();
    const auto truths = TruthOfGlints(studio, wet);
    ASSERT_EQ(truths.size(), 2u);
    for (int camera = 0; camera < 2; ++camera) {
      ASSERT_EQ(truths[camera].size(), wet.glint_names.size());
      const LinearPicture wet_picture = RenderSpeaker(studio, wet, camera, all);
      const LinearPicture dry_picture = RenderSpeaker(studio, dry, camera, all);
      for (const DotTruth& truth : truths[camera]) {
        if (truth.visible == 0) continue;
        ++seen;
        EXPECT_LT((BrightestAdded(wet_picture, dry_picture, truth.center_px) - truth.center_px)
                      .cwiseAbs()
                      .maxCoeff(),
                  2);
      }
    }
  }
  EXPECT_GE(seen, 8);
}

// Two cameras 100 degrees apart: what both take for one dot is nowhere near where their lines of
// sight come closest.
TEST(SpeakerSceneTest, GlintsAreNotOnePlaceForAllViews) {
  SpeakerLookOptions look;
  look.glints = true;
  const Studio studio(RingOfCameras(2, 1));
  const SpeakerScene filmed = SpeakerWith("mirror6", look).At(0, studio);
  const auto truths = TruthOfGlints(studio, filmed);
  const CameraArray& array = studio.cameras().array;
  int seen_twice = 0;
  for (std::size_t glint = 0; glint < filmed.glint_names.size(); ++glint) {
    if (truths[0][glint].visible == 0 || truths[1][glint].visible == 0) continue;
    ++seen_twice;
    const SightRay first = *studio.lens_view(0).RayThrough(truths[0][glint].center_px);
    const SightRay second = *studio.lens_view(1).RayThrough(truths[1][glint].center_px);
    const Eigen::Vector3d across = first.direction.cross(second.direction).normalized();
    const double apart_mm = std::abs(across.dot(first.origin_mm - second.origin_mm));
    const Eigen::Vector3d middle_mm = filmed.scene.wet_spots[glint].center_mm;
    const double moved_px = (*Project(array, {0, -1}, middle_mm) - truths[0][glint].center_px -
                             *Project(array, {1, -1}, middle_mm) + truths[1][glint].center_px)
                                .norm();
    EXPECT_TRUE(apart_mm > 0.5 || moved_px > 2) << filmed.glint_names[glint];
  }
  EXPECT_GE(seen_twice, 1);
}

TEST(SpeakerSceneTest, TheLightDriftsAndFlickers) {
  SpeakerLookOptions look;
  look.light_drift = 0.1;
  look.drift_period_s = 2;
  look.light_flicker = 0.05;
  look.flicker_hz = 12.5;
  const Studio studio(RingOfCameras(1, 1, {64, 48, 100}));
  const FilmedSpeaker speaker = SpeakerWith("mirror6", look);
  SpeakerLookOptions steady_look = look;
  steady_look.light_drift = steady_look.light_flicker = 0;
  const float steady =
      SpeakerWith("mirror6", steady_look).At(0, studio).scene.lights[0].radiance.x();
  // 12.5 Hz at 25 frames a second: up in one frame, down in the next.
  EXPECT_NEAR(speaker.At(0, studio).scene.lights[0].radiance.x() / steady, 1.05, 1e-5);
  EXPECT_NEAR(speaker.At(25, studio).scene.lights[0].radiance.x() / steady, 0.95, 1e-5);
  EXPECT_NEAR(speaker.At(12.5, studio).scene.lights[0].radiance.x() / steady, 1.1, 1e-5);
}

TEST(SpeakerSceneTest, ImpossibleLooksAreRefused) {
  SpeakerLookOptions look;
  look.dot_diameter_mm = 0;
  EXPECT_THAT(CheckOptions(look).error().message, testing::HasSubstr("dot_diameter_mm"));
  look = {};
  look.light_drift = 0.8;
  look.light_flicker = 0.3;
  EXPECT_THAT(CheckOptions(look).error().message, testing::HasSubstr("light_flicker"));
  look = {};
  look.diffuse_light = 1.5;
  EXPECT_THAT(CheckOptions(look).error().message, testing::HasSubstr("diffuse_light"));
}

}  // namespace
}  // namespace articap
