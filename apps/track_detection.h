// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/calibrate_input.h"
#include "core/camera.h"
#include "core/dots.h"
#include "core/report.h"
#include "core/result.h"
#include "tracking/dot_detector.h"
#include "tracking/perspective_correction.h"

namespace articap {

// A camera's dots, and what went wrong on the way.
struct DetectedVideo {
  DotVideo video;
  std::vector<std::string> notes;
  std::int64_t frames_promised = -1;  // by the file; -1: nothing was promised
  int crowded = 0;                    // frames with more dots than are looked at
  int damaged = 0;                    // frames that cannot be trusted
  int overexposed = 0;                // frames of which most is as bright as the file can say
  double perspective2_px2 = 0;  // sum over dots: by how much perspective had moved them, squared
};

// The videos of the calibration's cameras, in their order. A single video is a single camera's,
// whatever its name; else they go by their names.
Result<std::vector<NamedSource>> OpenVideosOf(const CameraArray& array,
                                              const std::vector<std::string>& paths);

// Dots, with perspective's bias taken out. Refused where there is a camera too many or too few, or
// where pictures have another size than their camera was calibrated for. What a video shows before
// it breaks off is kept.
Result<std::vector<DetectedVideo>> DetectVideos(const CameraArray& array,
                                                const std::vector<std::string>& paths,
                                                const DotDetectorOptions& options,
                                                const PerspectiveOptions& perspective);

// Not usable without any dots, and where a camera shows so many that they cannot be markers.
StageReport DescribeDetection(const std::vector<DetectedVideo>& videos,
                              const DotDetectorOptions& options,
                              const PerspectiveOptions& perspective);

}  // namespace articap
