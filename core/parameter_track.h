// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/time.h"

namespace articap {

enum class FitStatus : std::uint8_t {
  kOk,
  kNoHeadPose,     // the head could not be stabilised: no parameters
  kTooFewMarkers,  // too few markers seen: no parameters
  kNotConverged,   // the solver ran out of iterations: the best found
  // Some parameters were not determined by the markers seen: they hold the reference, or, under a
  // prior on smooth trajectories, follow their neighbours; their sigma is infinite.
  kWeak,
};
const char* NameOf(FitStatus status);

// The matrix Y that a control model trains on: frames x parameters, with names and units. Values
// are in rad and mm inside; files hold degrees for rotations, and say so in the name of the column.
struct ParameterTrack {
  std::vector<std::string> names;
  std::vector<std::string> units;  // "rad", "mm" or "1", a parameter each
  double rate_hz = 1;
  int first_frame = 1;
  SessionTime start;
  Eigen::MatrixXd values;  // frames x parameters; NaN where there is no fit
  // Standard deviations, same shape; infinite where not determined. Those of the markers' own
  // noise: neither the head pose's error nor what a prior on smooth trajectories knows is in them.
  Eigen::MatrixXd sigmas;
  std::vector<double> residuals_mm;  // per frame: mean distance of measured to virtual markers
  std::vector<FitStatus> statuses;
  std::vector<std::string> phones;  // per frame; empty where no labels were given

  int num_frames() const { return static_cast<int>(values.rows()); }
  int num_parameters() const { return static_cast<int>(values.cols()); }
};

// CSV: frame,time_s, then name[unit] a parameter, then sigma_name[unit] a parameter, residual_mm,
// status and, where there are labels, phone. Cells without a value are empty.
std::string WriteParameterCsv(const ParameterTrack& track);
Result<ParameterTrack> ParseParameterCsv(const std::string& text, const std::string& source_name);

// HDF5 with the datasets /parameters and /sigmas (frames x parameters, float64; attributes names,
// units), /time_s, /frame, /residual_mm, /status (attribute: the names of the codes), /phone, and
// the attributes rate_hz and articap_version. The same track gives the same bytes. The first 512
// bytes (HDF5's user block) hold a checksum; files that disagree with it are refused.
Result<void> WriteParameterHdf5(const ParameterTrack& track, const std::filesystem::path& path);
Result<ParameterTrack> ReadParameterHdf5(const std::filesystem::path& path);

}  // namespace articap
