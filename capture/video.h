// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/frame_source.h"
#include "core/options.h"
#include "core/result.h"
#include "core/time.h"

namespace articap {

enum class PixelColor : std::uint8_t {
  // Grey pictures: of colour video its luma, as the file holds it. Video of limited range has black
  // at 16 and white at 235 (of 255); it is not stretched, since that would clip what cameras record
  // beyond. More than 8 bits become kGray16, shifted up to its full range. Pictures in RGB become
  // grey by the weights of BT.601.
  kLuma,
  kRgb,
};

enum class FieldMode : std::uint8_t {
  kAuto,         // what the file says, and the pictures confirm
  kFrames,       // whole pictures, whatever the file says
  kTopFirst,     // two fields a picture, that of the top row first in time
  kBottomFirst,  // the other way round
};

struct VideoOptions {
  PixelColor color = PixelColor::kLuma;
  FieldMode fields = FieldMode::kAuto;
  SessionTime start;  // of the first frame: where the video's own time 0 lies on the session clock
};

void VisitOptions(VideoOptions& options, OptionVisitor& visit);

// A video that FFmpeg decodes. Several parts are what a camcorder cut one recording into
// (00001.MTS, 00002.MTS), in their order: one stream whose times go on. Parts that differ in size,
// rate or coding are refused.
//
// - Times are those that the file gives; the first frame's is options.start. A frame without one
//   follows its predecessor at the nominal rate. Gaps, repetitions and irregular times are noted.
//   info().constant_rate and notes may change as frames are read.
// - The file's wish to be turned by 90, 180 or 270 degrees is fulfilled; pixels that are not square
//   have a scale along the picture's (unturned) x in picture_from_image, edges on edges.
// - Interlaced video comes as fields, the one that was exposed first first, half a frame's time
//   apart. By FieldMode::kAuto that is decided by what the file says and by what the first 30 to
//   100 frames show where something moves (capture/comb.h); where they disagree, by the latter.
// - What cannot be decoded is an error of Next() that names file and frame; the frames behind it
//   come. Damaged ones are kCorrupt. Where the size of the pictures changes, the video ends with an
//   error.
// - info().frames is the number that the file's index names, or else estimated from its duration.
Result<std::unique_ptr<FrameSource>> OpenVideo(const std::vector<std::filesystem::path>& parts,
                                               const VideoOptions& options = {});

// How many pictures a file of video holds, of that many a second, by its packets: nothing is
// decoded.
Result<std::int64_t> CountPictures(const std::filesystem::path& path, double rate_hz);

}  // namespace articap
