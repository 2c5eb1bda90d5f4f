// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "core/alignment.h"
#include "synthetic/camera_rigs.h"
#include "synthetic/random.h"
#include "tests/tracking/rendered_take.h"

// From pictures of the synthetic speaker to labelled markers, against the truth.
namespace articap {
namespace {

constexpr double kWhole = 0.95;  // of a dot's outline: nothing to speak of hides it

// A labelled sample, and where it truly is.
struct Sample {
  int frame;
  int marker;
  int sights;
  bool is_whole;  // two views or more measured it, and each showed all of it
  Eigen::Vector3d found_mm;
  Eigen::Matrix3d covariance_mm2;
  Eigen::Vector3d true_mm;

  Eigen::Vector3d error_mm() const { return found_mm - true_mm; }
};

struct LabelCount {
  int visible = 0;   // samples of which a view shows the whole dot
  int labelled = 0;  // of these
  int wrong = 0;     // samples with a dot of something else
};

LabelCount CountLabels(const RenderedTake& take, const TrackedTake& tracked) {
  LabelCount count;
  for (int frame = 0; frame < take.num_frames(); ++frame)
    for (int marker = 0; marker < static_cast<int>(take.names.size()); ++marker) {
      const int index = tracked.labelling.frames[frame].points[marker];
      const bool is_visible = take.CountViews(frame, marker, kWhole) > 0;
      count.visible += is_visible ? 1 : 0;
      if (index < 0) continue;
      count.labelled += is_visible ? 1 : 0;
      const CloudPoint& point = tracked.clouds.frames[frame][index];
      const bool is_wrong =
          std::any_of(point.sights.begin(), point.sights.end(), [&](const DotSight& sight) {
            const Dot& dot = take.dots[frame][sight.view.camera][sight.dot];
            return take.OwnerOf(frame, sight.view.camera, dot, marker).marker != marker;
          });
      count.wrong += is_wrong ? 1 : 0;
    }
  return count;
}

bool IsWhole(const RenderedTake& take, int frame, int marker, const CloudPoint& point) {
  return point.sights.size() >= 2 &&
         std::all_of(point.sights.begin(), point.sights.end(), [&](const DotSight& sight) {
           const Dot& dot = take.dots[frame][sight.view.camera][sight.dot];
           return take.OwnerOf(frame, sight.view.camera, dot, marker).visible >= kWhole;
         });
}

Sample SampleOf(const RenderedTake& take, const TrackedTake& tracked, int frame, int marker) {
  const LabelledFrame& labelled = tracked.labelling.frames[frame];
  const CloudPoint& point = tracked.clouds.frames[frame][labelled.points[marker]];
  const auto sights = static_cast<int>(point.sights.size());
  const Eigen::Vector3d& truth_mm = take.positions_mm[frame][marker];
  if (sights > 1)
    return {frame,
            marker,
            sights,
            IsWhole(take, frame, marker, point),
            point.position_in_stage_mm,
            point.covariance_mm2,
            truth_mm};
  const Rigid3d stage_from_template = labelled.template_from_stage->Inverse();
  const Eigen::Matrix3d rotation = stage_from_template.rotation.toRotationMatrix();
  const MarkerPlace& place = labelled.places[marker];
  return {frame,
          marker,
          sights,
          false,
          stage_from_template * place.position_mm,
          rotation * place.covariance_mm2 * rotation.transpose(),
          truth_mm};
}

// The stage of a calibration is anybody's choice: what two views measure is moved onto the truth as
// one rigid whole.
std::vector<Sample> SamplesOf(const RenderedTake& take, const TrackedTake& tracked) {
  std::vector<Sample> samples;
  std::vector<Eigen::Vector3d> found_mm, true_mm;
  for (int frame = 0; frame < take.num_frames(); ++frame)
    for (int marker = 0; marker < static_cast<int>(take.names.size()); ++marker) {
      if (tracked.labelling.frames[frame].points[marker] < 0) continue;
      samples.push_back(SampleOf(take, tracked, frame, marker));
      if (!samples.back().is_whole) continue;
      found_mm.push_back(samples.back().found_mm);
      true_mm.push_back(samples.back().true_mm);
    }
  const Rigid3d true_from_found = AlignRigid(found_mm, true_mm);
  const Eigen::Matrix3d rotation = true_from_found.rotation.toRotationMatrix();
  for (Sample& sample : samples) {
    sample.found_mm = true_from_found * sample.found_mm;
    sample.covariance_mm2 = rotation * sample.covariance_mm2 * rotation.transpose();
  }
  return samples;
}

Eigen::Array3d RmsOf(const std::vector<Eigen::Vector3d>& errors) {
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (const Eigen::Vector3d& error : errors) squares += error.array().square();
  return (squares / static_cast<double>(std::max<std::size_t>(1, errors.size()))).sqrt();
}

// About the mean.
Eigen::Array3d DeviationOf(std::vector<Eigen::Vector3d> errors) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& error : errors) mean += error / static_cast<double>(errors.size());
  for (Eigen::Vector3d& error : errors) error -= mean;
  return RmsOf(errors);
}

void ExpectAccurate(const RenderedTake& take, const std::vector<Sample>& samples) {
  for (int marker = 0; marker < static_cast<int>(take.names.size()); ++marker) {
    std::vector<Eigen::Vector3d> errors, at_rest;
    for (const Sample& sample : samples) {
      if (sample.marker != marker || !sample.is_whole) continue;
      errors.push_back(sample.error_mm());
      if (sample.frame < take.rest_frames) at_rest.push_back(sample.error_mm());
    }
    if (errors.empty()) continue;
    const Eigen::Array3d rms = RmsOf(errors);
    std::printf("  %-14s %3zu whole in two views: RMSE %.4f %.4f %.4f mm",
                take.names[marker].c_str(), errors.size(), rms.x(), rms.y(), rms.z());
    EXPECT_LE(rms.maxCoeff(), 0.08) << take.names[marker];
    if (at_rest.size() >= 10) {
      const Eigen::Array3d deviation = DeviationOf(at_rest);
      std::printf(", at rest SD %.4f %.4f %.4f", deviation.x(), deviation.y(), deviation.z());
      EXPECT_LE(deviation.maxCoeff(), 0.03) << take.names[marker];
    }
    std::printf("\n");
  }
}

// The far corner of the mouth: where it is in the picture is seen, how far away is estimated.
void ExpectHonestDepth(const RenderedTake& take, const std::vector<Sample>& samples,
                       const std::string& name) {
  const auto marker =
      static_cast<int>(std::find(take.names.begin(), take.names.end(), name) - take.names.begin());
  std::vector<Eigen::Vector3d> errors;
  int within = 0;
  for (const Sample& sample : samples) {
    if (sample.marker != marker || sample.sights != 1) continue;
    // Along the axis of the greatest uncertainty, and across it.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(sample.covariance_mm2);
    const Eigen::Vector3d error = axes.eigenvectors().transpose() * sample.error_mm();
    errors.push_back(error);
    within += std::abs(error.z()) <= 2 * std::sqrt(axes.eigenvalues().z()) ? 1 : 0;
  }
  ASSERT_GE(errors.size(), 20U);
  const Eigen::Array3d rms = RmsOf(errors);
  const double share = static_cast<double>(within) / static_cast<double>(errors.size());
  std::printf(
      "  %-14s %3zu by one view: RMSE across the ray %.4f %.4f mm, along it %.3f mm, %.1f %% "
      "within two sigmas\n",
      name.c_str(), errors.size(), rms.x(), rms.y(), rms.z(), 100 * share);
  EXPECT_LE(rms.head<2>().maxCoeff(), 0.15);
  EXPECT_GE(share, 0.9);
}

void ExpectRightLabels(const RenderedTake& take, const TrackedTake& tracked) {
  const LabelCount count = CountLabels(take, tracked);
  std::printf("  %d of %d visible samples labelled, %d wrong\n", count.labelled, count.visible,
              count.wrong);
  EXPECT_EQ(count.labelled, count.visible);
  EXPECT_EQ(count.wrong, 0);
}

SpeakerLookOptions RetroReflective() {
  SpeakerLookOptions look;
  look.retro_reflective = true;
  return look;
}

// Samples of a speaker before mirrors, calibrated from pictures of a board.
std::pair<RenderedTake, std::vector<Sample>> TrackBeforeMirrors(const SyntheticCameras& cameras,
                                                                int num_frames, int num_boards) {
  RenderedTakeOptions options;
  options.cameras = cameras;
  options.num_frames = num_frames;
  options.film.look = RetroReflective();
  RenderedTake take = RenderTake(options);
  const TrackedTake tracked =
      TrackTake(take, CalibrateFromBoards(cameras, num_boards), options.map);
  ExpectRightLabels(take, tracked);
  std::vector<Sample> samples = SamplesOf(take, tracked);
  ExpectAccurate(take, samples);
  return {std::move(take), std::move(samples)};
}

// The set-up of Rademan and Niesler.
TEST(RenderedTrackingTest, OneMirror) {
  const auto [take, samples] = TrackBeforeMirrors(MirrorSetUp(4, 1), 50, 18);
  ExpectHonestDepth(take, samples, "right_corner");
}

TEST(RenderedTrackingTest, TwoMirrors) { TrackBeforeMirrors(TwoMirrorSetUp(4, 1), 30, 24); }

// A tenth of the dots goes, and every picture gets two that are nobody's, somewhere on the face.
void Disturb(const CameraArray& array, int seed, RenderedTake& take) {
  RandomGenerator random(seed, 1);
  for (auto& cameras : take.dots)
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      std::vector<Dot>& dots = cameras[camera];
      std::erase_if(dots, [&](const Dot&) { return random.Uniform() < 0.1; });
      for (int ghost = 0; ghost < 2 && !dots.empty(); ++ghost) {
        Dot dot = dots.front();
        dot.covariance_px2 = std::pow(0.03, 2) * Eigen::Matrix2d::Identity();
        dot.center_px = {array.cameras[camera].width * random.Uniform(0.3, 0.7),
                         array.cameras[camera].height * random.Uniform(0.2, 0.8)};
        dots.push_back(dot);
      }
    }
}

// The set-up of Beskow: markers on the face and on spectacles, before several cameras.
TEST(RenderedTrackingTest, FourCamerasWithDropoutsAndGhosts) {
  RenderedTakeOptions options;
  options.film.width = 640;
  options.film.height = 480;
  options.cameras = RingOfCameras(4, 1, CameraModelOf(options.film));
  options.film.look = RetroReflective();
  options.map = "spectacles30";
  options.rate_hz = 60;
  options.rest_s = 0.2;
  options.turn_deg = 20;
  options.num_frames = 40;
  const RenderedTake take = RenderTake(options);
  LabelCount count;
  std::vector<Sample> samples;
  for (int seed = 1; seed <= 8; ++seed) {
    RenderedTake disturbed = take;
    Disturb(options.cameras.array, seed, disturbed);
    const TrackedTake tracked = TrackTake(disturbed, options.cameras.array, options.map);
    const LabelCount once = CountLabels(disturbed, tracked);
    count.visible += once.visible;
    count.labelled += once.labelled;
    count.wrong += once.wrong;
    const std::vector<Sample> more = SamplesOf(disturbed, tracked);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  std::printf("  %d of %d visible samples labelled, %d wrong\n", count.labelled, count.visible,
              count.wrong);
  EXPECT_LE(count.wrong, 0.001 * count.labelled);
  EXPECT_GE(count.labelled, 0.995 * count.visible);
  // Also of what is half hidden, or touches another dot.
  std::vector<Eigen::Vector3d> errors;
  for (const Sample& sample : samples)
    if (sample.sights > 1) errors.push_back(sample.error_mm());
  const Eigen::Array3d rms = RmsOf(errors);
  std::printf("  %zu measured: RMSE %.4f %.4f %.4f mm\n", errors.size(), rms.x(), rms.y(), rms.z());
  EXPECT_LE(rms.maxCoeff(), 0.1);
}

}  // namespace
}  // namespace articap
