// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/image.h"
#include "core/result.h"

namespace articap {

enum class VideoCodec : std::uint8_t {
  kFfv1,  // lossless, in Matroska
  // As camcorders and webcams write it: lossy (libx264, yuv420p), in Matroska or MP4. Grey becomes
  // luma of full range, the same numbers.
  kH264,
};

enum class VideoContainer : std::uint8_t { kMatroska, kMp4 };

// Frames a second, exactly.
struct VideoRate {
  int frames = 25;
  int seconds = 1;
};
// The nearest with at most 1001000 in either number: 59.94 is 2997/50, 25 is 25/1.
VideoRate ClosestRate(double rate_hz);

struct VideoFormat {
  VideoCodec codec = VideoCodec::kFfv1;
  VideoContainer container = VideoContainer::kMatroska;
  double crf = 18;  // of H.264, "constant rate factor": 0 best to 51 worst
  int width = 0;    // px; of H.264 even
  int height = 0;
  PixelFormat pixels = PixelFormat::kGray8;  // or kGray16 with FFV1, kRgb8 with H.264
  VideoRate rate;
};

// Writes a video frame by frame, at exact times k seconds / frames; Matroska rounds them to
// milliseconds and names the rate beside. The same frames give the same bytes with one version of
// FFmpeg; of H.264 if the size is a multiple of 8. Fails where an encoder is missing, the pictures
// do not fit, or the disk is full.
class VideoWriter {
 public:
  static Result<std::unique_ptr<VideoWriter>> Create(const std::filesystem::path& path,
                                                     const VideoFormat& format);
  // Without Finish() the file is taken away again, unless there was one before.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // Of the size and pixels of the format.
  Result<void> Write(const ImageView& image);
  // The file is whole afterwards; nothing can be written any more.
  Result<void> Finish();

 private:
  class Output;

  explicit VideoWriter(std::unique_ptr<Output> output);
  std::unique_ptr<Output> output_;
};

}  // namespace articap
