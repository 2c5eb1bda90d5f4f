// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/frame_source.h"
#include "core/image.h"

namespace articap {

// A frame that owns its pixels, so that it outlives the source that it came from.
class StoredFrame {
 public:
  StoredFrame() = default;
  explicit StoredFrame(const Frame& frame) { Store(frame); }
  StoredFrame(StoredFrame&&) noexcept = default;
  StoredFrame& operator=(StoredFrame&&) noexcept = default;

  // In place of what was there, whose memory serves again.
  void Store(const Frame& frame);

  const Frame& frame() const { return frame_; }
  std::size_t num_bytes() const { return pixels_.bytes.size(); }

 private:
  Frame frame_;  // its image shows pixels_
  Image pixels_;
};

// A video in memory.
struct StoredVideo {
  FrameSourceInfo info;
  std::vector<StoredFrame> frames;
};
std::unique_ptr<FrameSource> OpenStored(std::shared_ptr<const StoredVideo> video);

}  // namespace articap
