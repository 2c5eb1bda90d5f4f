// SPDX-License-Identifier: MIT
#include "tests/tracking/speaker_dots.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/marker_set.h"
#include "rig/default_head/default_head.h"
#include "synthetic/random.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::uint64_t kStream = 102;

SyntheticTake TakeOf(const SpeakerDotsOptions& options) {
  static const FaceRig rig = MakeDefaultHead().value();
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / (options.map + ".toml")).value();
  SyntheticTakeOptions take;
  take.seed = static_cast<int>(options.seed);
  take.speech.rate_hz = options.rate_hz;
  take.speech.num_sentences = 1 + static_cast<int>(options.num_frames / options.rate_hz / 2);
  return SynthesizeTake(rig, set, take).value();
}

// Slow, and about the neck.
Rigid3d StageFromHead(double time_s, double turn_deg) {
  const double phase = 2 * std::numbers::pi * time_s / 2.5;
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(turn_deg * kDegree * std::sin(phase), Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(4 * kDegree * std::sin(1.7 * phase), Eigen::Vector3d::UnitX()));
  return {turn, Eigen::Vector3d(6 * std::sin(0.6 * phase), 4 * std::sin(1.1 * phase), 0)};
}

class DotMaker {
 public:
  explicit DotMaker(const SpeakerDotsOptions& options)
      : options_(options), random_(options.seed, kStream), take_(TakeOf(options)) {
    for (const View& view : options.cameras.array.views())
      projections_.push_back(ProjectionOf(options.cameras.array, view));
  }

  SpeakerDots Make() {
    SpeakerDots scene;
    scene.cameras = options_.cameras;
    scene.rate_hz = options_.rate_hz;
    scene.names = take_.markers.tracks.names();
    const int rest = static_cast<int>(options_.rate_hz / 2);  // most of the still beginning
    for (int frame = 0; frame < options_.num_frames; ++frame) AddFrame(rest + frame, frame, scene);
    return scene;
  }

 private:
  void AddFrame(int take_frame, int frame, SpeakerDots& scene) {
    const Rigid3d stage_from_head = StageFromHead(frame / options_.rate_hz, options_.turn_deg);
    const auto num_cameras = options_.cameras.array.cameras.size();
    scene.positions_mm.emplace_back();
    scene.dots.emplace_back(num_cameras);
    scene.owners.emplace_back(num_cameras);
    for (int m = 0; m < take_.markers.tracks.num_markers(); ++m) {
      const Eigen::Vector3d in_head = take_.true_pose.poses[take_frame].head_from_stage *
                                      take_.markers.tracks.position_mm(take_frame, m);
      const Eigen::Vector3d point = stage_from_head * in_head;
      const Eigen::Vector3d outwards = stage_from_head.rotation * OutwardsAt(in_head);
      scene.positions_mm.back().push_back(point);
      for (const ViewProjection& projection : projections_)
        AddSight(projection, point, outwards, m, scene);
    }
    for (int camera = 0; camera < static_cast<int>(num_cameras); ++camera)
      for (int ghost = 0; ghost < options_.ghosts; ++ghost) AddGhost(camera, scene);
  }

  // The head as a ball, around a point a little below the middle between the ears.
  static Eigen::Vector3d OutwardsAt(const Eigen::Vector3d& in_head) {
    return (in_head - Eigen::Vector3d(0, -20, 0)).normalized();
  }

  void AddSight(const ViewProjection& projection, const Eigen::Vector3d& point,
                const Eigen::Vector3d& outwards, int marker, SpeakerDots& scene) {
    const Eigen::Vector3d towards = (projection.eye_in_stage_mm - point).normalized();
    if (towards.dot(outwards) < std::cos(options_.most_oblique_deg * kDegree)) return;
    if (random_.Uniform() < options_.dropout) return;
    const auto point_px = Project(options_.cameras.array, projection.view, point);
    if (point_px) AddDot(projection.view.camera, *point_px, marker, scene);
  }

  void AddGhost(int camera, SpeakerDots& scene) {
    const Camera& of = options_.cameras.array.cameras[camera];
    // Where the face is, about.
    AddDot(
        camera,
        {of.width * (0.3 + 0.4 * random_.Uniform()), of.height * (0.2 + 0.6 * random_.Uniform())},
        -1, scene);
  }

  void AddDot(int camera, Eigen::Vector2d center_px, int owner, SpeakerDots& scene) {
    const Camera& of = options_.cameras.array.cameras[camera];
    center_px += options_.noise_px * Eigen::Vector2d{random_.Normal(), random_.Normal()};
    if (!(center_px.x() > 0 && center_px.x() < of.width - 1 && center_px.y() > 0 &&
          center_px.y() < of.height - 1))
      return;
    Dot dot;
    dot.center_px = center_px;
    dot.covariance_px2 = options_.noise_px * options_.noise_px * Eigen::Matrix2d::Identity();
    dot.shape_px2 = 9 * Eigen::Matrix2d::Identity();
    dot.contrast = 0.5;
    scene.dots.back()[camera].push_back(dot);
    scene.owners.back()[camera].push_back(owner);
  }

  const SpeakerDotsOptions& options_;
  RandomGenerator random_;
  SyntheticTake take_;
  std::vector<ViewProjection> projections_;
};

}  // namespace

std::vector<int> SpeakerDots::NumSights(int frame) const {
  std::vector<int> count(names.size(), 0);
  for (const auto& camera : owners[frame])
    for (const int owner : camera)
      if (owner >= 0) ++count[owner];
  return count;
}

int SpeakerDots::OwnerOf(int frame, const CloudPoint& point) const {
  int owner = -1;
  for (const DotSight& sight : point.sights) {
    const int seen = owners[frame][sight.view.camera][sight.dot];
    if (seen < 0 || (owner >= 0 && seen != owner)) return -1;
    owner = seen;
  }
  return owner;
}

bool SpeakerDots::HasOther(int frame, const CloudPoint& point, int marker) const {
  return std::any_of(point.sights.begin(), point.sights.end(), [&](const DotSight& sight) {
    const int owner = owners[frame][sight.view.camera][sight.dot];
    return owner >= 0 && owner != marker;
  });
}

SpeakerDots MakeSpeakerDots(const SpeakerDotsOptions& options) { return DotMaker(options).Make(); }

MarkerTemplate TemplateOf(const SpeakerDots& scene, int frame) {
  MarkerTemplate result;
  for (std::size_t m = 0; m < scene.names.size(); ++m) {
    const bool is_rigid = scene.names[m].starts_with("spectacles");
    result.markers.push_back(
        {scene.names[m], scene.positions_mm[frame][m], is_rigid ? 0.5 : 5.0, is_rigid});
  }
  return result;
}

PointClouds CloudsOf(const SpeakerDots& scene, const ReconstructOptions& options) {
  PointClouds clouds;
  clouds.rate_hz = scene.rate_hz;
  clouds.frames = Reconstruct(scene.cameras.array, scene.dots, options);
  return clouds;
}

LabelScore ScoreOf(const SpeakerDots& scene, const PointClouds& clouds,
                   const Labelling& labelling) {
  LabelScore score;
  double squares = 0;
  std::vector<int> swap_run(scene.names.size(), 0);
  for (int frame = 0; frame < scene.num_frames(); ++frame) {
    const std::vector<int> sights = scene.NumSights(frame);
    for (std::size_t m = 0; m < scene.names.size(); ++m) {
      if (sights[m] >= 1) ++score.seen;
      const int index = labelling.frames[frame].points[m];
      const bool has_label = index >= 0;
      const bool right =
          has_label && scene.OwnerOf(frame, clouds.frames[frame][index]) == static_cast<int>(m);
      const bool swapped =
          has_label && scene.HasOther(frame, clouds.frames[frame][index], static_cast<int>(m));
      swap_run[m] = swapped ? swap_run[m] + 1 : 0;
      score.longest_swap = std::max(score.longest_swap, swap_run[m]);
      if (!has_label) continue;
      ++score.labelled;
      if (!right) continue;
      ++score.right;
      if (clouds.frames[frame][index].sights.size() < 2) continue;
      ++score.measured;
      const Eigen::Vector3d error_mm =
          clouds.frames[frame][index].position_in_stage_mm - scene.positions_mm[frame][m];
      squares += error_mm.squaredNorm();
      score.worst_mm = std::max(score.worst_mm, error_mm.norm());
    }
  }
  score.rms_mm = std::sqrt(squares / 3 / std::max(score.measured, 1));
  return score;
}

}  // namespace articap
