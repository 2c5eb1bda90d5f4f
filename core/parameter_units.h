// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "core/parameter_track.h"

namespace articap {

// How a unit of the track stands in files: rotations in degrees, all else as it is.
struct FileUnit {
  std::string name;              // in files
  double in_file_per_value = 1;  // value in the file = in_file_per_value * value of the track
};

inline constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

FileUnit FileUnitOf(std::string_view unit);

// The way back: the track's unit of a unit found in a file; nothing where it is not known.
struct TrackUnit {
  std::string name;              // in the track
  double value_per_in_file = 1;  // value of the track = value_per_in_file * value in the file
};
std::optional<TrackUnit> TrackUnitOf(std::string_view unit_in_file);

std::optional<FitStatus> FitStatusNamed(std::string_view name);
inline constexpr FitStatus kAllFitStatuses[] = {FitStatus::kOk, FitStatus::kNoHeadPose,
                                                FitStatus::kTooFewMarkers, FitStatus::kNotConverged,
                                                FitStatus::kWeak};

// The tables of a track agree in size (a bug where not).
void CheckSizes(const ParameterTrack& track);

}  // namespace articap
