// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "apps/output_set.h"
#include "capture/video_writer.h"
#include "core/options.h"
#include "core/result.h"
#include "synthetic/board_session.h"
#include "synthetic/film.h"

namespace articap {

// What `articap synthesize` films, and into which files.
struct SynthesizeVideoOptions {
  std::string cameras;  // a set-up as CamerasByName() has them; empty: no video
  VideoCodec codec = VideoCodec::kFfv1;
  double crf = 18;
  int boards = 0;  // how many pictures of a board the same cameras take
  FilmOptions film;
};
void VisitOptions(SynthesizeVideoOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const SynthesizeVideoOptions& options, const SensorOptions& sensor,
                          double rate_hz);

// Adds to the outputs, in `folder`:
//   <camera>.mkv              a video for each camera; .mp4 with H.264
//   truth.calibration.toml    the cameras and mirrors as they are
//   truth.dots.csv            what every view shows of every dot (Film::DotsOf)
//   boards/<camera>/0001.png  and boards/board.txt, which names the board: to calibrate from
// They are made when the outputs are committed.
Result<void> AddVideo(const FilmedSpeaker& speaker, const SynthesizeVideoOptions& options,
                      const SensorOptions& sensor, int seed, const std::filesystem::path& folder,
                      OutputSet& outputs);

}  // namespace articap
