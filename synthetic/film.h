// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/options.h"
#include "core/result.h"
#include "synthetic/speaker_scene.h"

namespace articap {

// How a speaker is filmed.
struct FilmOptions {
  int width = 1280;  // of the pictures, px
  int height = 720;
  std::optional<double> focal_px;  // of the lenses; else 2.5 times the height
  double glass_mm = 4;             // before the silver of mirrors
  // How long the shutter is open for each frame, the frame's time in the middle; 0: nothing blurs.
  double shutter_s = 0;
  int blur_instants = 7;  // of which a blurred picture is the mean
  // From the first row of a picture to the last (a rolling shutter), the frame's time in the
  // middle; 0: all rows at once. In so many bands of rows, each with one instant.
  double readout_s = 0;
  int readout_bands = 12;
  SpeakerLookOptions look;
};
void VisitOptions(FilmOptions& options, OptionVisitor& visit);
// At so many frames a second.
Result<void> CheckOptions(const FilmOptions& options, double rate_hz);
CameraModel CameraModelOf(const FilmOptions& options);

// A take as cameras record it.
class Film {
 public:
  Film(FilmedSpeaker speaker, Studio studio, const FilmOptions& options,
       const SensorOptions& sensor, std::uint64_t seed);

  const Studio& studio() const { return studio_; }
  int num_frames() const { return speaker_.take().truth.num_frames(); }
  // On one thread; frames may be asked for from several.
  Image Picture(int frame, int camera) const;
  // One line a view and marker: frame (from 1), time_s, view, marker, x_px, y_px, visible,
  // diameter_px; what these are: DotTruth. Then the glints, which are no markers: "glint_nose_tip".
  // At the frame's time, whatever the shutter does.
  static std::string DotsHeader();
  std::string DotsOf(int frame) const;

 private:
  // What arrives while the shutter is open about an instant.
  LinearPicture LightAt(double frame, int camera, const PictureRows& rows) const;
  LinearPicture RollingLight(int frame, int camera) const;

  FilmedSpeaker speaker_;
  Studio studio_;
  FilmOptions options_;
  SensorOptions sensor_;
  std::uint64_t seed_;
};

}  // namespace articap
