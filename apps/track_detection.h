// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "apps/calibrate_input.h"
#include "apps/video_detection.h"
#include "core/camera.h"
#include "core/report.h"
#include "core/result.h"

namespace articap {

// The videos of the calibration's cameras, in their order. A single video is a single camera's,
// whatever its name; else they go by their names.
Result<std::vector<NamedSource>> OpenVideosOf(const CameraArray& array,
                                              const std::vector<std::string>& paths);

// The dots of all cameras. Refused where there is a camera too many or too few, or where pictures
// have another size than their camera was calibrated for. What a video shows before it breaks off
// is kept. `room_bytes`: for pictures that are to be looked at again.
Result<std::vector<DetectedVideo>> DetectVideos(const CameraArray& array,
                                                const std::vector<std::string>& paths,
                                                const DetectionOptions& options,
                                                std::size_t room_bytes);
// From memory where all pictures are there; else the files.
Result<std::vector<NamedSource>> OpenAgain(const CameraArray& array,
                                           const std::vector<std::string>& paths,
                                           const std::vector<DetectedVideo>& videos);

// Not usable without any dots, and where a camera shows so many that they cannot be markers.
StageReport DescribeDetection(const std::vector<DetectedVideo>& videos,
                              const DetectionOptions& options);

}  // namespace articap
