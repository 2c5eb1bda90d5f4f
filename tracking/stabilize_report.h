// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/report.h"
#include "tracking/frame_aligner.h"
#include "tracking/pose_smoothing.h"
#include "tracking/reference_search.h"
#include "tracking/stabilize.h"

namespace articap {

// What the frames of a take say about each reference.
struct ReferenceStatistics {
  std::vector<int> num_seen;
  // In the frames with a pose.
  std::vector<int> num_outliers;
  std::vector<int> num_used;
  std::vector<double> sum_of_squares_mm2;  // of the residuals of those used

  explicit ReferenceStatistics(int num_references)
      : num_seen(num_references),
        num_outliers(num_references),
        num_used(num_references),
        sum_of_squares_mm2(num_references) {}
};

// How well the references would place the markers of the face, were all of them seen.
struct Conditioning {
  double rotation_sigma_rad = 0;
  double face_sigma_mm = 0;  // of the worst placed marker
  double error_gain = 0;     // face_sigma over the sigma of the references
  std::string worst_marker;
};
Conditioning ConditioningOf(const ReferenceModel& model, const std::vector<std::string>& names,
                            const std::vector<Eigen::Vector3d>& points_mm);

// Everything that the rigid mode found out, for its report.
struct RigidFindings {
  const StageTracks& tracks;
  const ReferenceModel& model;
  const ReferenceStatistics& statistics;
  Conditioning conditioning;
  std::optional<ReferenceSearch> search;
  std::vector<double> deviation_mm;  // from a given shape; empty without one
  std::string axes;
  std::string origin;
};

// Counts of the statuses; usable where at least half of the frames have a pose.
void ReportPoses(const HeadPoseTrack& head_pose, StageReport& report);
void ReportSmoothing(const PoseSmoothing& smoothing, StageReport& report);
void ReportReferences(const RigidFindings& findings, const StabilizeOptions& options,
                      StageReport& report);

}  // namespace articap
