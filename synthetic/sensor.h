// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

#include "core/image.h"
#include "core/options.h"
#include "core/result.h"
#include "render/picture.h"

namespace articap {

enum class ToneCurve : std::uint8_t {
  kLinear,  // machine vision
  kSrgb,    // camcorders and webcams, near enough
};

// What happens to light between the lens and the file.
struct SensorOptions {
  PixelFormat format = PixelFormat::kGray8;
  double blur_px = 0.6;   // SD of the lens' Gaussian blur
  double defocus_px = 0;  // radius of the disc that a point out of focus becomes
  double vignetting = 0;  // part of the light that the farthest corner loses, 0 to 1
  double exposure = 1;    // part of the full well that linear light 1 fills; more saturates
  bool noise = true;      // of photons and of reading out
  double full_well_e = 10000;
  double read_noise_e = 5;
  double black_level = 0;  // part of the range that is shown without light, so that noise has room
  ToneCurve tone = ToneCurve::kLinear;
};

void VisitOptions(SensorOptions& options, OptionVisitor& visit);
// Names the option that makes no sense.
Result<void> CheckOptions(const SensorOptions& options);

// Takes a picture. Noise depends on the seed alone; every picture wants its own.
Image Expose(const LinearPicture& light, const SensorOptions& options, std::uint64_t seed);

// What arrives while things move: the mean of pictures at evenly spread instants of the exposure.
// render_at gets the part of it that has passed, 0 to 1.
LinearPicture MotionBlur(int num_instants,
                         const std::function<LinearPicture(double part)>& render_at);

}  // namespace articap
