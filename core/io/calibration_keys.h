// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.h"
#include "core/toml_reader.h"

// What the reader and the writers of calibration.toml and its like share.
namespace articap {

inline std::string TomlList(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + TomlFloat(number);
  return "[" + text + "]";
}

inline std::string TomlList(const Eigen::Vector3d& vector) {
  return TomlList(std::vector<double>{vector.x(), vector.y(), vector.z()});
}

// Its rows.
inline std::string TomlMatrix(const Eigen::Matrix3d& matrix) {
  return fmt::format("[{}, {}, {}]", TomlList(Eigen::Vector3d(matrix.row(0))),
                     TomlList(Eigen::Vector3d(matrix.row(1))),
                     TomlList(Eigen::Vector3d(matrix.row(2))));
}

// What [metadata] says where articap wrote the file: then every key must be one that is known.
inline constexpr char kCalibrationLayout[] = "articap 1";

// The sigmas of a camera by their keys; a key that is left out is a sigma that is not known.
inline std::vector<std::pair<std::string, double*>> KeyedSigmas(CameraSigmas& sigmas) {
  static constexpr std::array kDistortion = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
  std::vector<std::pair<std::string, double*>> keyed = {{"fx_px", &sigmas.fx_px},
                                                        {"fy_px", &sigmas.fy_px},
                                                        {"cx_px", &sigmas.cx_px},
                                                        {"cy_px", &sigmas.cy_px}};
  for (std::size_t i = 0; i < kDistortion.size(); ++i)
    keyed.emplace_back(kDistortion[i], &sigmas.distortion[i]);
  for (int axis = 0; axis < 3; ++axis)
    keyed.emplace_back(fmt::format("rotation_{}_rad", "xyz"[axis]), &sigmas.rotation_rad[axis]);
  for (int axis = 0; axis < 3; ++axis)
    keyed.emplace_back(fmt::format("translation_{}_mm", "xyz"[axis]), &sigmas.translation_mm[axis]);
  keyed.emplace_back("time_offset_s", &sigmas.time_offset_s);
  return keyed;
}

}  // namespace articap
