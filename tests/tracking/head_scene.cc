// SPDX-License-Identifier: MIT
#include "tests/tracking/head_scene.h"

#include <cmath>
#include <numbers>

#include "core/alignment.h"
#include "core/check.h"
#include "core/landmarks.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

// Slow nods, turns and sways, in a stage that is turned against the head.
Rigid3d StageFromTruth(double time_s) {
  const auto wave = [&](double hz, double phase) {
    return std::sin(2 * std::numbers::pi * hz * time_s + phase);
  };
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, -1).normalized()) *
      Eigen::AngleAxisd(0.15 * wave(0.31, 0), Eigen::Vector3d::UnitX()) *
      Eigen::AngleAxisd(0.25 * wave(0.17, 1), Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(0.08 * wave(0.23, 2), Eigen::Vector3d::UnitZ());
  return {rotation, {300 + 20 * wave(0.11, 0), 800 + 15 * wave(0.29, 1), 50 * wave(0.07, 3)}};
}

// The jaw drops by up to 12 mm, four times a second, taking the lower lip along.
Eigen::Vector3d Talk(const LandmarkInfo& landmark, double time_s) {
  const double opening_mm = 6 * (1 - std::cos(2 * std::numbers::pi * 4 * time_s));
  if (landmark.region == "jaw" || landmark.region == "lower_lip")
    return {0, -opening_mm, -opening_mm / 4};
  if (landmark.region == "left_cheek" || landmark.region == "right_cheek")
    return {0, -opening_mm / 3, 0};
  return Eigen::Vector3d::Zero();
}

}  // namespace

MarkerSet SpectaclesSet() {
  auto set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml");
  ARTICAP_CHECK(set.has_value());
  return *set;
}

HeadScene MakeHeadScene(const HeadSceneOptions& options) {
  std::mt19937 random(options.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  HeadScene scene;
  scene.set = SpectaclesSet();
  std::vector<std::string> names;
  for (const MarkerRole& marker : scene.set.markers) names.push_back(marker.name);
  const double rate_hz = 60;
  scene.tracks = StageTracks(names, options.num_frames, rate_hz);
  for (const MarkerRole& marker : scene.set.markers)
    if (marker.head_reference)
      scene.references.points.push_back({marker.name, FindLandmark(marker.landmark)->typical_mm});
  for (int frame = 0; frame < options.num_frames; ++frame) {
    const double time_s = frame / rate_hz;
    const Rigid3d stage_from_truth = StageFromTruth(time_s);
    scene.truth_from_stage.push_back(stage_from_truth.Inverse());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const LandmarkInfo& landmark = *FindLandmark(scene.set.markers[i].landmark);
      Eigen::Vector3d point_mm = stage_from_truth * (landmark.typical_mm + Talk(landmark, time_s));
      point_mm +=
          options.noise_mm * Eigen::Vector3d{normal(random), normal(random), normal(random)};
      const Eigen::Vector3d direction{normal(random), normal(random), normal(random)};
      if (uniform(random) < options.outliers)
        point_mm += options.outlier_mm * direction.normalized();
      if (uniform(random) >= options.dropout)
        scene.tracks.Set(frame, static_cast<int>(i), point_mm);
    }
  }
  return scene;
}

Rigid3d HeadFromTruth(const HeadShape& in_head, const HeadShape& in_truth) {
  std::vector<Eigen::Vector3d> head_mm, truth_mm;
  for (const NamedPoint& point : in_head.points) {
    head_mm.push_back(point.point_in_head_mm);
    truth_mm.push_back(in_truth.Find(point.name)->point_in_head_mm);
  }
  return AlignRigid(truth_mm, head_mm);
}

}  // namespace articap
