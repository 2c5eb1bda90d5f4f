// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/libav.h"
#include "capture/video.h"
#include "core/image.h"
#include "core/result.h"

namespace articap::libav {

enum class Rows : std::uint8_t { kAll, kTop, kBottom };

// Pixels of decoded frames as pictures of ours, turned as the file asks.
class FramePixels {
 public:
  // Quarter turns clockwise, 0 to 3.
  FramePixels(PixelColor color, int quarter_turns) : color_(color), turns_(quarter_turns) {}

  // Whole, or one field of it. Valid as long as the frame and until the next call.
  Result<ImageView> Convert(const AVFrame& frame, Rows rows);

 private:
  // Rows whose ends may be written over, as libav's fast conversions do.
  struct Buffer {
    std::vector<std::uint8_t> bytes;
    ImageView Make(PixelFormat format, int width, int height);
  };

  ImageView Luma(const AVFrame& frame);
  Result<ImageView> Scale(const AVFrame& frame, PixelFormat format);
  ImageView Turn(const ImageView& image);

  PixelColor color_;
  int turns_;
  Owner<SwsContext> scaler_;
  Buffer converted_, turned_;
};

}  // namespace articap::libav
