// SPDX-License-Identifier: MIT
#include "tracking/stabilize.h"

#include <fmt/format.h>

#include <limits>
#include <numbers>

#include "core/statistics.h"
#include "tracking/anatomy.h"
#include "tracking/head_axes.h"
#include "tracking/rigidity.h"
#include "tracking/stabilize_report.h"
#include "tracking/stabilize_setup.h"

namespace articap {
namespace {

HeadPoseTrack EmptyPoseTrack(const StageTracks& tracks, StabilizationMode mode) {
  return {mode, tracks.rate_hz(), tracks.first_frame(), tracks.start(), {}};
}

std::vector<Eigen::Vector3d> MedianPositionsInHead(const HeadTracks& tracks, int max_frames) {
  std::vector<Eigen::Vector3d> medians_mm(tracks.num_markers());
  const std::vector<int> frames = SpreadFrames(tracks.num_frames(), max_frames);
  for (int marker = 0; marker < tracks.num_markers(); ++marker)
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> coordinates;
      for (const int frame : frames)
        if (!tracks.is_missing(frame, marker))
          coordinates.push_back(tracks.position_mm(frame, marker)[axis]);
      medians_mm[marker][axis] = MedianOf(std::move(coordinates));
    }
  return medians_mm;
}

// Declared axes are not measured: the face itself shows whether they can be true.
Result<void> CheckDeclaredAxes(const MarkerSet& set, const HeadTracks& tracks, int max_frames,
                               StageReport& report) {
  const AnatomyFindings anatomy =
      CheckAnatomy(PlaceLandmarks(set, tracks.names(), MedianPositionsInHead(tracks, max_frames)));
  if (anatomy.is_mirrored) return Fail(MirroredMessage(anatomy));
  WarnOfExchangedNames(anatomy, report);
  constexpr double kLargestTilt = std::numbers::pi / 4;
  if (anatomy.tilt_rad > kLargestTilt)
    report.warnings.push_back(
        fmt::format("the face lies {:.0f} degrees off the axes left, up, forward that were "
                    "declared: check them "
                    "(--left, --up, --forward, or [head] in the map)",
                    anatomy.tilt_rad * 180 / std::numbers::pi));
  return {};
}

// The modes translation (one reference) and none.
Result<StageResult<Stabilized>> StabilizeByDeclaration(const StageTracks& tracks,
                                                       const MarkerSet& set,
                                                       const StabilizeSetup& setup,
                                                       const StabilizeOptions& options) {
  const Eigen::Quaterniond head_from_stage =
      setup.axes ? HeadFromStage(*setup.axes) : Eigen::Quaterniond::Identity();
  Stabilized output;
  output.head_pose = EmptyPoseTrack(tracks, setup.mode);
  output.head_pose.poses.resize(tracks.num_frames());
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    HeadPose& pose = output.head_pose.poses[frame];
    pose.head_from_stage.rotation = head_from_stage;
    if (setup.mode == StabilizationMode::kNone) continue;
    const int reference = setup.references[0];
    const SampleState state = tracks.state(frame, reference);
    if (state == SampleState::kMeasured || (state == SampleState::kFilled && options.use_filled))
      pose.head_from_stage.translation_mm =
          -(head_from_stage * tracks.position_mm(frame, reference));
    else
      pose = {{}, std::numeric_limits<double>::quiet_NaN(), HeadPoseStatus::kTooFewReferences};
  }
  output.tracks = ToHead(tracks, output.head_pose);

  StageReport report = StartReport(setup, options);
  ReportPoses(output.head_pose, report);
  report.texts.emplace_back("mode", NameOf(setup.mode));
  report.texts.emplace_back("axes", setup.axes ? "as declared" : "those of the data");
  if (setup.mode == StabilizationMode::kTranslation) {
    report.texts.emplace_back("origin", tracks.names()[setup.references[0]]);
    output.head_shape.points.push_back(
        {tracks.names()[setup.references[0]], Eigen::Vector3d::Zero()});
    report.warnings.emplace_back(
        "the rotation of the head is declared, not measured: what the head turned is in the "
        "tracks");
  }
  if (options.check_anatomy)
    if (auto plausible = CheckDeclaredAxes(set, output.tracks, options.shape_frames, report);
        !plausible)
      return tl::unexpected(plausible.error());
  return StageResult<Stabilized>{std::move(output), std::move(report)};
}

}  // namespace

Result<StageResult<Stabilized>> Stabilize(const StageTracks& tracks, const MarkerSet& set,
                                          const std::optional<HeadShape>& given_shape,
                                          const StabilizeOptions& options) {
  const auto setup = ResolveSetup(tracks, set, given_shape, options);
  if (!setup) return tl::unexpected(setup.error());
  if (setup->mode == StabilizationMode::kRigid)
    return StabilizeRigid(tracks, set, given_shape, *setup, options);
  return StabilizeByDeclaration(tracks, set, *setup, options);
}

}  // namespace articap
