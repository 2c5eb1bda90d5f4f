// SPDX-License-Identifier: MIT
#include "synthetic/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "synthetic/board_session.h"

namespace articap {
namespace {

// Numbers that are not known are left out.
std::string Decimals(double value, int count) {
  return std::isnan(value) ? "" : fmt::format("{:.{}f}", value, count);
}

}  // namespace

void VisitOptions(FilmOptions& options, OptionVisitor& visit) {
  visit("width", options.width, "of the pictures; px");
  visit("height", options.height, "of the pictures; px");
  visit("focal_px", options.focal_px, "of the lenses; else 2.5 times the height; px");
  visit("glass_mm", options.glass_mm, "before the silver of mirrors; mm");
  visit("shutter_s", options.shutter_s, "how long each frame is exposed; 0: nothing blurs; s");
  visit("blur_instants", options.blur_instants, "instants that a blurred picture is the mean of");
  visit("readout_s", options.readout_s,
        "from the first row to the last of a rolling shutter; 0: all rows at once; s");
  visit("readout_bands", options.readout_bands, "bands of rows with one instant each");
  VisitOptions(options.look, visit);
}

Result<void> CheckOptions(const FilmOptions& options, double rate_hz) {
  constexpr int kMost_px = 8192;
  for (const auto& [name, value, least, most] :
       {std::tuple("width", options.width, 16, kMost_px),
        std::tuple("height", options.height, 16, kMost_px),
        std::tuple("blur_instants", options.blur_instants, 1, 1000),
        std::tuple("readout_bands", options.readout_bands, 1, options.height)})
    if (value < least || value > most)
      return Fail(fmt::format("{} is {}; it must be between {} and {}", name, value, least, most));
  if (options.focal_px && !(*options.focal_px > 0))
    return Fail(fmt::format("focal_px is {}; it must be positive", *options.focal_px));
  if (auto valid = RequireNotNegative({{"glass_mm", options.glass_mm},
                                       {"shutter_s", options.shutter_s},
                                       {"readout_s", options.readout_s}});
      !valid)
    return valid;
  if (!(options.shutter_s <= 1 / rate_hz))
    return Fail(
        fmt::format("shutter_s is {}, longer than a frame at {} Hz", options.shutter_s, rate_hz));
  if (!(options.readout_s <= 1 / rate_hz))
    return Fail(
        fmt::format("readout_s is {}, longer than a frame at {} Hz", options.readout_s, rate_hz));
  return CheckOptions(options.look);
}

CameraModel CameraModelOf(const FilmOptions& options) {
  constexpr double kFocalOverHeight = 2.5;
  return {options.width, options.height,
          options.focal_px.value_or(kFocalOverHeight * options.height)};
}

Film::Film(FilmedSpeaker speaker, Studio studio, const FilmOptions& options,
           const SensorOptions& sensor, std::uint64_t seed)
    : speaker_(std::move(speaker)),
      studio_(std::move(studio)),
      options_(options),
      sensor_(sensor),
      seed_(seed) {}

LinearPicture Film::LightAt(double frame, int camera, const PictureRows& rows) const {
  const double blur_frames = options_.shutter_s * speaker_.take().truth.rate_hz;
  const auto at = [&](double part) {
    return RenderSpeaker(studio_, speaker_.At(frame + (part - 0.5) * blur_frames, studio_), camera,
                         rows);
  };
  return blur_frames > 0 ? MotionBlur(options_.blur_instants, at) : at(0.5);
}

// A band of rows has the instant of its middle.
LinearPicture Film::RollingLight(int frame, int camera) const {
  const double readout_frames = options_.readout_s * speaker_.take().truth.rate_hz;
  LinearPicture picture;
  for (int band = 0; band < options_.readout_bands; ++band) {
    const PictureRows rows = {band * options_.height / options_.readout_bands,
                              (band + 1) * options_.height / options_.readout_bands};
    const double part = (0.5 * (rows.begin + rows.end) - 0.5) / (options_.height - 1) - 0.5;
    LinearPicture light = LightAt(frame + part * readout_frames, camera, rows);
    if (band == 0) {
      picture = std::move(light);
      continue;
    }
    const auto first = static_cast<std::ptrdiff_t>(rows.begin) * options_.width;
    const auto end = static_cast<std::ptrdiff_t>(rows.end) * options_.width;
    std::copy(light.rgb.begin() + first, light.rgb.begin() + end, picture.rgb.begin() + first);
  }
  return picture;
}

Image Film::Picture(int frame, int camera) const {
  const LinearPicture light = options_.readout_s > 0 ? RollingLight(frame, camera)
                                                     : LightAt(frame, camera, {0, options_.height});
  return Expose(light, sensor_, PictureSeed(seed_, camera, frame));
}

std::string Film::DotsHeader() {
  return "frame,time_s,view,marker,x_px,y_px,visible,diameter_px\n";
}

std::string Film::DotsOf(int frame) const {
  const SyntheticTake& take = speaker_.take();
  const CameraArray& array = studio_.cameras().array;
  const std::vector<View> views = array.views();
  const SpeakerScene filmed = speaker_.At(frame, studio_);
  std::string text;
  const auto add = [&](const View& view, const std::vector<std::string>& names,
                       const std::vector<DotTruth>& truths) {
    for (std::size_t i = 0; i < names.size(); ++i)
      fmt::format_to(std::back_inserter(text), "{},{:.6f},{},{},{},{},{:.2f},{}\n", frame + 1,
                     frame / take.truth.rate_hz, array.NameOf(view), names[i],
                     Decimals(truths[i].center_px.x(), 4), Decimals(truths[i].center_px.y(), 4),
                     truths[i].visible, Decimals(truths[i].diameter_px, 3));
  };
  const auto dots = TruthOfDots(studio_, filmed);
  const auto glints = TruthOfGlints(studio_, filmed);
  for (std::size_t view = 0; view < views.size(); ++view) {
    add(views[view], take.markers.tracks.names(), dots[view]);
    add(views[view], filmed.glint_names, glints[view]);
  }
  return text;
}

}  // namespace articap
