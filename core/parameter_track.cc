// SPDX-License-Identifier: MIT
#include "core/parameter_track.h"

#include "core/check.h"
#include "core/parameter_units.h"

namespace articap {

const char* NameOf(FitStatus status) {
  switch (status) {
    case FitStatus::kOk:
      return "ok";
    case FitStatus::kNoHeadPose:
      return "no_head_pose";
    case FitStatus::kTooFewMarkers:
      return "too_few_markers";
    case FitStatus::kNotConverged:
      return "not_converged";
    case FitStatus::kWeak:
      return "weak";
  }
  ARTICAP_CHECK(false);
}

std::optional<FitStatus> FitStatusNamed(std::string_view name) {
  for (const FitStatus status : kAllFitStatuses)
    if (name == NameOf(status)) return status;
  return std::nullopt;
}

FileUnit FileUnitOf(std::string_view unit) {
  if (unit == "rad") return {"deg", kDegreesPerRadian};
  return {std::string(unit), 1};
}

std::optional<TrackUnit> TrackUnitOf(std::string_view unit_in_file) {
  if (unit_in_file == "deg") return TrackUnit{"rad", 1 / kDegreesPerRadian};
  if (unit_in_file == "rad" || unit_in_file == "mm" || unit_in_file == "1")
    return TrackUnit{std::string(unit_in_file), 1};
  return std::nullopt;
}

void CheckSizes(const ParameterTrack& track) {
  const std::size_t num_frames = static_cast<std::size_t>(track.num_frames());
  const std::size_t num_parameters = static_cast<std::size_t>(track.num_parameters());
  ARTICAP_CHECK_EQ(track.names.size(), num_parameters);
  ARTICAP_CHECK_EQ(track.units.size(), num_parameters);
  ARTICAP_CHECK_EQ(track.sigmas.rows(), track.values.rows());
  ARTICAP_CHECK_EQ(track.sigmas.cols(), track.values.cols());
  ARTICAP_CHECK_EQ(track.residuals_mm.size(), num_frames);
  ARTICAP_CHECK_EQ(track.statuses.size(), num_frames);
  ARTICAP_CHECK(track.phones.empty() || track.phones.size() == num_frames);
  ARTICAP_CHECK(track.rate_hz > 0);
}

}  // namespace articap
