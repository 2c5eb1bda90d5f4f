// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/calibrate_input.h"
#include "apps/progress.h"
#include "capture/frame_memory.h"
#include "core/camera.h"
#include "core/dots.h"
#include "core/result.h"
#include "tracking/dot_detector.h"
#include "tracking/perspective_correction.h"

namespace articap {

struct DetectionOptions {
  DotDetectorOptions dots;
  PerspectiveOptions perspective;
};

// A camera's dots, and what went wrong on the way.
struct DetectedVideo {
  DotVideo video;
  std::vector<std::string> notes;
  std::int64_t frames_promised = -1;  // by the file; -1: nothing was promised
  int crowded = 0;                    // frames with more dots than are looked at
  int damaged = 0;                    // frames that cannot be trusted
  int overexposed = 0;                // frames of which most is as bright as the file can say
  double perspective2_px2 = 0;        // sum of the squares of what perspective had moved dots by
  std::shared_ptr<const StoredVideo> pictures;  // null where there was no room for them
};

// Reads a camera's video and finds its dots, several frames at once; perspective's bias is taken
// out. What comes before a fault is kept. Of `room_bytes` for pictures, what these take is taken
// away; where they do not fit, none is kept.
Result<DetectedVideo> DetectVideo(NamedSource& named, const Lens& lens,
                                  const DetectionOptions& options, std::size_t& room_bytes,
                                  Progress& progress);

}  // namespace articap
