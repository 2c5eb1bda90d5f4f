// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "capture/frame_pixels.h"
#include "capture/stream_decoder.h"
#include "capture/video.h"
#include "core/result.h"

namespace articap::libav {

// What a video is, found in its header and its first pictures.
struct VideoFacts {
  // Files that are read as one, each group after the other.
  std::vector<std::vector<std::filesystem::path>> groups;
  int width = 0;  // of the decoded pictures, before they are turned
  int height = 0;
  int pixel_format = -1;    // libav's
  double pixel_aspect = 1;  // width over height of a pixel
  int quarter_turns = 0;    // clockwise
  double rate_hz = 0;       // of whole pictures
  std::chrono::nanoseconds tick{0};
  bool constant_rate = true;              // as far as was looked
  FieldMode fields = FieldMode::kFrames;  // never kAuto
  std::int64_t frames = -1;               // whole pictures; -1: not known
  std::vector<std::string> notes;
};

// The facts, and a decoder of the first group that has just begun.
struct ProbedVideo {
  VideoFacts facts;
  std::unique_ptr<StreamDecoder> decoder;
};
Result<ProbedVideo> ProbeVideo(const std::vector<std::filesystem::path>& parts,
                               const VideoOptions& options);

// Where the pixels of a picture, or of its fields, lie in the turned picture of square pixels.
PictureFromImage PictureFromRows(const VideoFacts& facts, Rows rows);

}  // namespace articap::libav
