// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/camera_io.h"

// The formats behind ParseCameras(), one source each.
namespace articap {

using CameraReader = Result<CameraReading>(const std::string& text, const std::string& source_name,
                                           const CameraReadOptions& options);
CameraReader ReadCameraToml;
CameraReader ReadQualisysCameras;

Result<CameraReading> ReadOpenCvCameras(const std::string& text, const std::string& extrinsics_text,
                                        const std::string& source_name,
                                        const CameraReadOptions& options);

}  // namespace articap
