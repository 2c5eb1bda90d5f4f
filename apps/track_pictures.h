// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/calibrate_input.h"
#include "core/camera.h"
#include "core/dots.h"
#include "core/options.h"
#include "render/picture.h"
#include "tracking/doubt.h"
#include "tracking/take_marks.h"

namespace articap {

// What a person is shown of a tracked take.
struct ShowOptions {
  int doubtful = 24;     // places of doubt on the contact sheet; 0: no sheet
  bool overlay = false;  // videos with what was found in them
  double overlay_crf = 20;
  // Pictures of the videos may take so much memory; else the videos are read twice.
  int memory_mb = 1000;
};
void VisitOptions(ShowOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const ShowOptions& options);
// For pictures that will be looked at again; none where none will. Bytes.
std::size_t RoomForPictures(const ShowOptions& options);

// Opens the videos of all cameras, in their order, at their first frames.
using OpenVideos = std::function<Result<std::vector<NamedSource>>()>;

// A tracked take with the pictures that it was tracked in, which are read anew.
struct PicturedTake {
  const CameraArray& array;
  const std::vector<DotVideo>& videos;  // one a camera: when its frames were taken
  OpenVideos open;
  std::vector<std::string> names;  // of the markers
  TakeMarks marks;
  double rate_hz;
  SessionTime start;
  int first_frame;

  // The frame of a camera that is nearest in time to an instant of the take, as its number in the
  // video; the instant nearest to a frame.
  std::int64_t PictureAt(int camera, int instant) const;
  int InstantOf(int camera, SessionTime time) const;
};

// Of every doubt a picture: how each view that shows the marker, or should, sees it and its
// neighbours, with the names that they got.
Result<std::vector<Picture>> DoubtPictures(const PicturedTake& take,
                                           const std::vector<Doubt>& doubts);
// All of them with what is doubted, the greatest first.
Picture DoubtSheet(const PicturedTake& take, const std::vector<Doubt>& doubts,
                   const std::vector<Picture>& pictures);

// The video of a camera with everything that was found in it, H.264 in colour. Videos of less than
// 700 lines become twice as large, so that names can be read.
Result<void> WriteOverlay(const PicturedTake& take, int camera, double crf,
                          const std::filesystem::path& path);

}  // namespace articap
