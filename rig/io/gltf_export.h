// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "rig/face_rig.h"

namespace articap {

// Parameters of a rig over time, one row a frame.
struct RigAnimation {
  std::string name = "speech";
  double rate_hz = 60;
  double start_s = 0;  // time of the first frame
  Eigen::MatrixXd parameters;
};

struct ExportReport {
  // Largest distance of a vertex of the file from the rig's, where the file is read back and
  // evaluated by the rules of glTF, float32, over `poses_compared` poses.
  double largest_deviation_mm = 0;
  int poses_compared = 0;
  std::size_t bytes = 0;
  std::vector<std::string> target_names;
};

// A file that deviates more from the rig is not written.
constexpr double kMaxExportDeviation_mm = 0.3;

// GLB in metres: one mesh with a primitive and material for each part, the jaw as a skinned joint,
// every other parameter as a morph target. A target stands for its parameter at its maximum, so
// that the weight is value / maximum; the mesh's extras hold targetNames and, for each, unit, range
// and scale.
Result<ExportReport> ExportGlb(const FaceRig& rig, const std::optional<RigAnimation>& animation,
                               const std::filesystem::path& path);

// One pose as an OBJ file, mm, groups named after parts, colours behind the vertices.
Result<void> ExportObj(const FaceRig& rig, const Eigen::VectorXd& parameters,
                       const std::filesystem::path& path);

}  // namespace articap
