// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/frame_source.h"

namespace articap {

// Whether the program ffmpeg is there to make files for tests.
bool HasFfmpeg();
// Runs it in a folder with these arguments, split by the shell; throws with what it says where it
// fails.
void RunFfmpeg(const std::filesystem::path& folder, const std::string& arguments);

// A film whose pictures tell their number: before a dark gradient a bright bar of kBarWidth_px
// pixels and the full height moves to the right by `step_px` a picture, from kFirstBar_px.
struct BarFilm {
  int width = 160;
  int height = 64;
  int num_frames = 20;
  int step_px = 4;
  double rate_hz = 50;
  bool gray16 = false;
};
inline constexpr int kBarWidth_px = 12;
inline constexpr int kFirstBar_px = 10;

// Writes it as bars.gray, uncompressed, and gives ffmpeg's arguments to read that.
std::string WriteBars(const std::filesystem::path& folder, const BarFilm& film);

// Where the bar is, px: the middle of what is brighter than the mean of the darkest and the
// brightest, along x or, in pictures turned by a quarter, along y.
double BarAt(const ImageView& image, bool along_y = false);
// Where it is in picture `number` of a film.
inline double BarOf(const BarFilm& film, int number) {
  return kFirstBar_px + film.step_px * number + (kBarWidth_px - 1) / 2.0;
}

// Everything that a source gives, read to its end.
struct SeenFrame {
  double time_s = 0;
  double bar_px = 0;
  FrameStatus status = FrameStatus::kGood;
  PictureFromImage picture_from_image;
  int width = 0, height = 0;
  PixelFormat format = PixelFormat::kGray8;
};
struct SeenFilm {
  std::vector<SeenFrame> frames;
  std::vector<std::string> errors;
};
SeenFilm ReadAll(FrameSource& source, bool along_y = false);

}  // namespace articap

#define ARTICAP_NEEDS_FFMPEG() \
  if (!::articap::HasFfmpeg()) \
  GTEST_SKIP() << "the program ffmpeg, which makes the files, is not there"
