// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include "core/calibration_toml.h"
#include "core/camera_io.h"
#include "core/file_io.h"
#include "tests/support/result.h"
#include "tests/support/test_data.h"

namespace articap {

inline std::filesystem::path CameraFile(const std::string& name) {
  return SourceFolder() / "tests/golden/cameras" / name;
}

inline std::string TextOfCameraFile(const std::string& name) {
  return OrThrow(ReadFile(CameraFile(name)));
}

// Two cameras of unlike models, a mirror, sigmas that are known in part.
inline CameraArray InventedCameras() {
  return OrThrow(ReadCalibration(CameraFile("calibration.toml")));
}

// With the first `what` replaced, which must be there.
inline std::string Replaced(std::string text, const std::string& what, const std::string& instead) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("there is no " + what);
  return text.replace(at, what.size(), instead);
}

// Why ParseCameras() refuses a text; empty where it does not.
inline std::string RefusalOf(const std::string& text, const CameraReadOptions& options = {}) {
  const auto reading = ParseCameras(text, "file", options);
  return reading ? std::string() : reading.error().message;
}

}  // namespace articap
