// SPDX-License-Identifier: MIT
#include "core/head_pose.h"

#include "core/check.h"

namespace articap {

const char* NameOf(StabilizationMode mode) {
  switch (mode) {
    case StabilizationMode::kRigid:
      return "rigid";
    case StabilizationMode::kTranslation:
      return "translation";
    case StabilizationMode::kNone:
      return "none";
  }
  ARTICAP_CHECK(false);
}

const char* NameOf(HeadPoseStatus status) {
  switch (status) {
    case HeadPoseStatus::kOk:
      return "ok";
    case HeadPoseStatus::kTooFewReferences:
      return "too_few_references";
    case HeadPoseStatus::kIllConditioned:
      return "ill_conditioned";
    case HeadPoseStatus::kLargeResidual:
      return "large_residual";
  }
  ARTICAP_CHECK(false);
}

HeadTracks ToHead(const StageTracks& tracks, const HeadPoseTrack& head_pose) {
  ARTICAP_CHECK_EQ(static_cast<std::size_t>(tracks.num_frames()), head_pose.poses.size());
  HeadTracks in_head(tracks.names(), tracks.num_frames(), tracks.rate_hz(), tracks.first_frame(),
                     tracks.start());
  for (int frame = 0; frame < tracks.num_frames(); ++frame) {
    const HeadPose& pose = head_pose.poses[frame];
    if (!pose.is_known()) continue;
    const Eigen::Matrix3d rotation = pose.head_from_stage.rotation.toRotationMatrix();
    const Eigen::Vector3d translation_mm = pose.head_from_stage.translation_mm;
    for (int marker = 0; marker < tracks.num_markers(); ++marker) {
      if (tracks.is_missing(frame, marker)) continue;
      in_head.Set(frame, marker, rotation * tracks.position_mm(frame, marker) + translation_mm,
                  tracks.state(frame, marker), tracks.sigma_mm(frame, marker));
    }
  }
  return in_head;
}

}  // namespace articap
