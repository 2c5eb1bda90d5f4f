// SPDX-License-Identifier: MIT
#include "tracking/gap_frames.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "core/alignment.h"
#include "core/head_pose.h"
#include "tracking/frame_aligner.h"
#include "tracking/pose_smoothing.h"
#include "tracking/reference_shape.h"
#include "tracking/rigidity.h"

namespace articap {
namespace {

constexpr AlignerOptions kAlignerOptions{.use_filled = true};
constexpr int kShapeFrames = 500;
constexpr int kFewestMarkers = 3;
constexpr int kFewestPoses = 30;  // for SmoothPoses
constexpr double kMostRotationSigma_rad = 1.5 * std::numbers::pi / 180;
constexpr double kCutoff_hz = 3;

// The markers as one body.
ReferenceModel ShapeOf(const StageTracks& tracks) {
  std::vector<int> all(tracks.num_markers());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> frames = SpreadFrames(tracks.num_frames(), kShapeFrames);
  const DistanceStatistics distances =
      MeasureDistances(tracks, all, frames, kAlignerOptions.use_filled);
  const std::vector<double> sigmas_mm =
      WeightingSigmas(SigmasOfMembers(distances.variance_mm2, all));
  return EstimateReferenceShape(tracks, all, sigmas_mm, distances, frames, kAlignerOptions);
}

// Poses of all frames, with their precisions: zero where the markers do not tell.
struct CarriedPoses {
  HeadPoseTrack track;
  std::vector<double> precisions;
};

CarriedPoses PoseFrames(const StageTracks& tracks, const ReferenceModel& shape) {
  FrameAligner aligner(tracks, shape, kAlignerOptions);
  CarriedPoses poses{
      {StabilizationMode::kRigid, tracks.rate_hz(), tracks.first_frame(), tracks.start(), {}},
      std::vector<double>(tracks.num_frames())};
  poses.track.poses.resize(tracks.num_frames());
  Eigen::Quaterniond previous = Eigen::Quaterniond::Identity();
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    const FrameAlignment alignment = aligner.Align(frame);
    if (alignment.num_used < kFewestMarkers ||
        !(alignment.rotation_sigma_rad <= kMostRotationSigma_rad))
      continue;
    Rigid3d& pose = poses.track.poses[frame].head_from_stage;
    pose = alignment.shape_from_stage;
    // q and -q are one rotation; the smoother wants neighbours of one sign.
    if (pose.rotation.dot(previous) < 0) pose.rotation.coeffs() *= -1;
    previous = pose.rotation;
    poses.precisions[frame] = 1 / std::pow(alignment.rotation_sigma_rad, 2);
  }
  return poses;
}

}  // namespace

std::vector<Rigid3d> FollowHead(const StageTracks& tracks) {
  std::vector<Rigid3d> local_from_stage(tracks.num_frames());
  if (tracks.num_markers() < kFewestMarkers) return local_from_stage;
  const ReferenceModel shape = ShapeOf(tracks);
  std::vector<Eigen::Vector3d> known_mm;
  std::ranges::copy_if(shape.points_mm, std::back_inserter(known_mm),
                       [](const Eigen::Vector3d& point_mm) { return point_mm.allFinite(); });
  if (known_mm.size() < kFewestMarkers) return local_from_stage;
  CarriedPoses poses = PoseFrames(tracks, shape);
  if (std::ranges::count_if(poses.precisions, [](double p) { return p > 0; }) < kFewestPoses)
    return local_from_stage;
  const double cutoff_hz = std::clamp(kCutoff_hz, kLowestPoseCutoff * tracks.rate_hz(),
                                      kHighestPoseCutoff * tracks.rate_hz());
  // Poses of no precision are taken for known, so that the smoother bridges them.
  SmoothPoses(poses.precisions, SpreadOf(known_mm).centroid, cutoff_hz, &poses.track);
  for (int frame = 0; frame < tracks.num_frames(); ++frame)
    local_from_stage[frame] = poses.track.poses[frame].head_from_stage;
  return local_from_stage;
}

Eigen::MatrixXd LocalSeries(const StageTracks& tracks,
                            const std::vector<Rigid3d>& local_from_stage) {
  Eigen::MatrixXd series = Eigen::MatrixXd::Zero(tracks.num_frames(), 3 * tracks.num_markers());
  for (int marker = 0; marker < tracks.num_markers(); ++marker) {
    auto points_mm = series.middleCols<3>(3 * marker);
    int last = -1;  // frame in which it was seen
    for (int frame = 0; frame < tracks.num_frames(); ++frame) {
      if (tracks.is_missing(frame, marker)) continue;
      points_mm.row(frame) = local_from_stage[frame] * tracks.position_mm(frame, marker);
      const Eigen::RowVector3d start_mm = points_mm.row(last < 0 ? frame : last);
      for (int between = last + 1; between < frame; ++between)
        points_mm.row(between) =
            start_mm + (points_mm.row(frame) - start_mm) * (static_cast<double>(between - last) /
                                                            static_cast<double>(frame - last));
      last = frame;
    }
    for (int frame = last + 1; frame < tracks.num_frames() && last >= 0; ++frame)
      points_mm.row(frame) = points_mm.row(last).eval();
  }
  return series;
}

}  // namespace articap
