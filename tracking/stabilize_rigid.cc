// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/alignment.h"
#include "core/statistics.h"
#include "tracking/anatomy.h"
#include "tracking/exchange_check.h"
#include "tracking/frame_aligner.h"
#include "tracking/head_axes.h"
#include "tracking/pose_smoothing.h"
#include "tracking/reference_shape.h"
#include "tracking/rigidity.h"
#include "tracking/shape_check.h"
#include "tracking/stabilize_report.h"
#include "tracking/stabilize_setup.h"

namespace articap {
namespace {

const Eigen::Vector3d kNowhere =
    Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

std::vector<std::string> NamesOf(const StageTracks& tracks, const std::vector<int>& columns) {
  std::vector<std::string> names;
  for (const int column : columns) names.push_back(tracks.names()[column]);
  return names;
}

// The take's own shape, or an error where the references are never seen together.
Result<ReferenceModel> OwnShape(const StageTracks& tracks, const std::vector<int>& references,
                                std::span<const int> frames, const AlignerOptions& options) {
  const DistanceStatistics distances =
      MeasureDistances(tracks, references, frames, options.use_filled);
  std::vector<int> members(references.size());
  std::iota(members.begin(), members.end(), 0);
  const auto sigmas_mm = WeightingSigmas(SigmasOfMembers(distances.variance_mm2, members));
  ReferenceModel model =
      EstimateReferenceShape(tracks, references, sigmas_mm, distances, frames, options);
  const auto num_known = std::ranges::count_if(
      model.points_mm, [](const Eigen::Vector3d& point) { return point.allFinite(); });
  if (num_known < 3)
    return Fail(fmt::format(
        "no frame shows three of the references ({}) together: the head cannot be found; choose "
        "other references, or fill their gaps",
        fmt::join(NamesOf(tracks, references), ", ")));
  return model;
}

// Replaces the take's own shape by the given one, without references that are out of place.
Result<ShapeComparison> AdoptGivenShape(const std::vector<std::string>& names,
                                        const HeadShape& given, double tolerance_mm,
                                        ReferenceModel& model) {
  // References that wander by themselves cannot be expected nearer to their places than that.
  constexpr double kWanderSigmas = 4;
  auto comparison =
      CompareWithShape(names, model.points_mm, given,
                       std::max(tolerance_mm, kWanderSigmas * MedianOf(model.sigmas_mm)));
  if (!comparison) return comparison;
  for (int i = 0; i < model.size(); ++i) {
    const NamedPoint* point = given.Find(names[i]);
    const bool is_misplaced =
        std::ranges::find(comparison->misplaced, i) != comparison->misplaced.end();
    model.points_mm[i] = point && !is_misplaced ? point->point_in_head_mm : kNowhere;
    if (!point)
      comparison->warnings.push_back(fmt::format(
          "the reference '{}' is not in the reference shape and is left out", names[i]));
    // What a reference is off its place adds to its noise; a third of the square to a coordinate.
    if (const double off_mm = comparison->deviation_mm[i]; point && std::isfinite(off_mm))
      model.sigmas_mm[i] = std::hypot(model.sigmas_mm[i], off_mm / std::sqrt(3.0));
  }
  return comparison;
}

// Markers on the skull or the nose that the given shape holds besides the references: have they
// moved against the references since? Then the spectacles sit elsewhere on the face.
void CheckWitnesses(const StageTracks& tracks, const MarkerSet& set, const HeadShape& given,
                    const std::vector<int>& references,
                    const std::vector<Eigen::Vector3d>& medians_in_head_mm, StageReport& report) {
  constexpr double kNoticeableMm = 2.5;  // skin over bone shifts by one or two
  std::vector<double> offsets_mm;
  std::vector<std::string> texts;
  for (const NamedPoint& point : given.points) {
    const auto column = tracks.Find(point.name);
    const MarkerRole* role = set.Find(point.name);
    if (!column || !role || std::ranges::find(references, *column) != references.end()) continue;
    if (RegionOf(*role) != "skull" && RegionOf(*role) != "nose") continue;
    const double offset_mm = (medians_in_head_mm[*column] - point.point_in_head_mm).norm();
    if (std::isnan(offset_mm)) continue;
    offsets_mm.push_back(offset_mm);
    texts.push_back(fmt::format("'{}' {:.1f} mm", point.name, offset_mm));
  }
  if (offsets_mm.empty() || MedianOf(offsets_mm) < kNoticeableMm) return;
  report.warnings.push_back(fmt::format(
      "the references have moved against the face since the reference shape was made ({}): the "
      "spectacles were seated anew; bind this take on a reference pose of its own",
      fmt::join(texts, ", ")));
}

// Refuses mirrored data and exchanged names that the axes would be built on.
Result<void> CheckFace(const std::vector<PlacedLandmark>& landmarks, StageReport& report) {
  const AnatomyFindings anatomy = CheckAnatomy(landmarks);
  if (anatomy.is_mirrored) return Fail(MirroredMessage(anatomy));
  WarnOfExchangedNames(anatomy, report);
  return {};
}

// The mean rotation from the shape to the stage: the eigenvector of the largest eigenvalue of
// sum q q^T (Markley et al. 2007), which is what BestRotation maximises over sum R.
Eigen::Quaterniond MeanStageFromShape(FrameAligner& aligner, std::span<const int> frames) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const int frame : frames)
    if (const FrameAlignment alignment = aligner.Align(frame); alignment.num_used >= 3)
      sum += alignment.shape_from_stage.rotation.conjugate().toRotationMatrix();
  return BestRotation(sum);
}

Eigen::Vector3d CentroidOfKnown(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Vector3d sum_mm = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Eigen::Vector3d& point_mm : points_mm) {
    if (!point_mm.allFinite()) continue;
    sum_mm += point_mm;
    ++count;
  }
  return sum_mm / count;
}

HeadPoseStatus StatusOf(const FrameAlignment& alignment, const StabilizeOptions& options) {
  if (alignment.num_seen < 3) return HeadPoseStatus::kTooFewReferences;
  const double max_sigma_rad = options.max_rotation_sigma_deg * std::numbers::pi / 180;
  if (!(alignment.rotation_sigma_rad <= max_sigma_rad)) return HeadPoseStatus::kIllConditioned;
  // Three that are left after others were put aside cannot confirm one another.
  const bool is_unconfirmed = alignment.num_used <= 3 && alignment.num_used < alignment.num_seen;
  if (is_unconfirmed || alignment.rms_mm > options.max_residual_mm)
    return HeadPoseStatus::kLargeResidual;
  return HeadPoseStatus::kOk;
}

struct PosedTake {
  HeadPoseTrack head_pose;
  ReferenceStatistics statistics;
  std::vector<int> suspects;       // frames with several outliers
  std::vector<double> precisions;  // relative, of each frame's pose; 0 where it is not known
};

// A pose is as precise as its references are by number and place, and as they agree.
double PrecisionOf(const FrameAlignment& alignment, const StabilizeOptions& options) {
  const double disagreement = std::max(1.0, alignment.rms_mm / options.max_residual_mm);
  return 1 / std::pow(alignment.rotation_sigma_rad * disagreement, 2);
}

PosedTake PoseEveryFrame(const StageTracks& tracks, FrameAligner& aligner,
                         const Rigid3d& head_from_shape, const StabilizeOptions& options) {
  const int num_references = aligner.model().size();
  PosedTake take{
      {StabilizationMode::kRigid, tracks.rate_hz(), tracks.first_frame(), tracks.start(), {}},
      ReferenceStatistics(num_references),
      {},
      std::vector<double>(tracks.num_frames())};
  take.head_pose.poses.resize(tracks.num_frames());
  Eigen::Quaterniond previous = Eigen::Quaterniond::Identity();
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    const FrameAlignment alignment = aligner.Align(frame);
    HeadPose& pose = take.head_pose.poses[frame];
    pose.status = StatusOf(alignment, options);
    pose.residual_mm = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < num_references; ++i)
      take.statistics.num_seen[i] += aligner.robust_weights()[i] > 0;
    if (!pose.is_known()) continue;
    pose.residual_mm = alignment.rms_mm;
    take.precisions[frame] = PrecisionOf(alignment, options);
    pose.head_from_stage = head_from_shape * alignment.shape_from_stage;
    // q and -q are one rotation; the sign of the frame before keeps the components continuous.
    if (pose.head_from_stage.rotation.dot(previous) < 0)
      pose.head_from_stage.rotation.coeffs() *= -1;
    previous = pose.head_from_stage.rotation;
    if (alignment.num_seen - alignment.num_used >= 2) take.suspects.push_back(frame);
    for (int i = 0; i < num_references; ++i) {
      const double residual_mm = aligner.residuals_mm()[i];
      if (std::isnan(residual_mm)) continue;
      const bool is_outlier = aligner.IsOutlier(i);
      take.statistics.num_outliers[i] += is_outlier;
      take.statistics.num_used[i] += !is_outlier;
      if (!is_outlier) take.statistics.sum_of_squares_mm2[i] += residual_mm * residual_mm;
    }
  }
  return take;
}

HeadShape ShapeInHead(const StageTracks& tracks, const ReferenceModel& model,
                      const Rigid3d& head_from_shape) {
  HeadShape shape;
  for (int i = 0; i < model.size(); ++i)
    if (model.points_mm[i].allFinite())
      shape.points.push_back(
          {tracks.names()[model.columns[i]], head_from_shape * model.points_mm[i]});
  return shape;
}

void WarnOfRareReferences(const StageTracks& tracks, const ReferenceModel& model,
                          const ReferenceStatistics& statistics, StageReport& report) {
  for (int i = 0; i < model.size(); ++i) {
    const std::string& name = tracks.names()[model.columns[i]];
    const int num_missing = tracks.CountMissing(model.columns[i]);
    if (num_missing == tracks.num_frames())
      report.warnings.push_back(fmt::format("the reference '{}' is never seen: lost?", name));
    else if (!model.points_mm[i].allFinite() && statistics.num_seen[i] == 0)
      continue;
    else if (2 * num_missing > tracks.num_frames())
      report.warnings.push_back(fmt::format("the reference '{}' is missing from {} of {} frames",
                                            name, num_missing, tracks.num_frames()));
  }
}

}  // namespace

Result<StageResult<Stabilized>> StabilizeRigid(const StageTracks& tracks, const MarkerSet& set,
                                               const std::optional<HeadShape>& given_shape,
                                               const StabilizeSetup& setup,
                                               const StabilizeOptions& options) {
  StageReport report = StartReport(setup, options);
  const AlignerOptions aligner_options{options.outlier_sigmas, options.use_filled};
  const std::vector<int> shape_frames = SpreadFrames(tracks.num_frames(), options.shape_frames);

  auto model = OwnShape(tracks, setup.references, shape_frames, aligner_options);
  if (!model) return tl::unexpected(model.error());
  std::vector<double> deviation_mm;
  if (given_shape) {
    const auto comparison = AdoptGivenShape(NamesOf(tracks, setup.references), *given_shape,
                                            options.shape_tolerance_mm, *model);
    if (!comparison) return tl::unexpected(comparison.error());
    deviation_mm = comparison->deviation_mm;
    report.warnings.insert(report.warnings.end(), comparison->warnings.begin(),
                           comparison->warnings.end());
  }

  FrameAligner aligner(tracks, *model, aligner_options);
  const auto medians_mm = MedianPositions(tracks, aligner, shape_frames);
  const auto landmarks = PlaceLandmarks(set, tracks.names(), medians_mm);
  if (options.check_anatomy)
    if (auto face = CheckFace(landmarks, report); !face) return tl::unexpected(face.error());
  HeadAxes axes{{}, "of the given shape", "of the given shape"};
  if (given_shape) {
    CheckWitnesses(tracks, set, *given_shape, setup.references, medians_mm, report);
  } else {
    auto found = FindHeadAxes(landmarks, setup.axes, MeanStageFromShape(aligner, shape_frames),
                              CentroidOfKnown(model->points_mm));
    if (!found) return tl::unexpected(found.error());
    axes = std::move(*found);
  }

  PosedTake take = PoseEveryFrame(tracks, aligner, axes.head_from_shape, options);
  if (options.smooth_pose) {
    const PoseSmoothing smoothing =
        SmoothPoses(take.precisions, axes.head_from_shape * CentroidOfKnown(model->points_mm),
                    options.pose_cutoff_hz, &take.head_pose);
    ReportSmoothing(smoothing, report);
  }
  Stabilized output{std::move(take.head_pose), {}, {}};
  output.tracks = ToHead(tracks, output.head_pose);
  output.head_shape = ShapeInHead(tracks, *model, axes.head_from_shape);

  ReportPoses(output.head_pose, report);
  report.texts.emplace_back("mode", NameOf(StabilizationMode::kRigid));
  RigidFindings findings{tracks,          *model,
                         take.statistics, ConditioningOf(*model, tracks.names(), medians_mm),
                         std::nullopt,    deviation_mm,
                         axes.axes,       axes.origin};
  if (options.propose)
    findings.search =
        SearchReferences(tracks, set, setup.references, medians_mm, shape_frames, aligner_options);
  ReportReferences(findings, options, report);
  WarnOfRareReferences(tracks, *model, take.statistics, report);
  const auto exchanges =
      FindExchangesInFrames(tracks, *model, take.suspects, options.max_residual_mm / 2);
  report.warnings.insert(report.warnings.end(), exchanges.begin(), exchanges.end());
  return StageResult<Stabilized>{std::move(output), std::move(report)};
}

}  // namespace articap
