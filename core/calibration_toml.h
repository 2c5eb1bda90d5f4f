// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "core/camera.h"
#include "core/result.h"

namespace articap {

// calibration.toml: a CameraArray in the layout of aniposelib's CameraGroup, lengths in mm
// (docs/calibration-files.md has every key). aniposelib takes every table but [metadata] for a
// camera, and ignores the keys of a camera that it does not know: so the mirrors are tables within
// [metadata], and what else articap knows of a camera, its sigmas included, is in the camera's
// table. Numbers are the shortest that read back as the same double; rotation vectors are rounded
// to 1e-13 rad, so that write(read(write(x))) equals write(x) byte for byte.
std::string WriteCalibration(const CameraArray& array);

// Files of articap, aniposelib and Caliscope whose unit is known or plausibly mm; ReadCameras()
// (core/camera_io.h) has options for the others. Anything that would not be a camera is refused.
Result<CameraArray> ParseCalibration(const std::string& toml_text, const std::string& source_name);
Result<CameraArray> ReadCalibration(const std::filesystem::path& path);

}  // namespace articap
