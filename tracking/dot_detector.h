// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/dots.h"
#include "core/frame_source.h"
#include "core/image.h"
#include "core/options.h"
#include "core/result.h"
#include "tracking/pixel_noise.h"
#include "tracking/simd_level.h"

namespace articap {

enum class DotPolarity : std::uint8_t { kBright, kDark };

// From light to the values of a file.
enum class DotTone : std::uint8_t {
  kLinear,  // machine vision
  kSrgb,    // camcorders and webcams, near enough: undone before dots are fitted
};

struct DotDetectorOptions {
  DotPolarity polarity = DotPolarity::kBright;
  double min_diameter_px = 4;  // of the camera's picture
  double max_diameter_px = 40;
  double min_roundness = 0.45;  // shortest over longest axis of the ellipse
  // Highlights of eyes and wet skin end more softly than dots do. SD of the fitted blur, the
  // pixels' own in it; sharp pictures have 0.6 to 0.8, and motion adds to it.
  double max_blur_px = 2.5;
  // A dot differs from what surrounds it by this part of the full range (of linear light, with
  // tone), and by `sensitivity` standard deviations of a pixel's noise: smaller finds fainter ones.
  double min_contrast = 0.06;
  double sensitivity = 6;
  // What the pixels of a dot, not of its ground, may leave of the model beyond noise, root mean
  // square over the contrast. Dots on even ground have some 0.01, on a face 0.03, glints 0.1; a dot
  // that leaves much is fitted again, robustly, for something may hide a part of it.
  double max_misfit = 0.085;
  // Of the dots in pictures in colour, "#rrggbb" as the file has it; empty: bright or dark ones.
  std::string color;
  DotTone tone = DotTone::kLinear;
  // Standard deviation of the noise without light, and variance that light adds per light, parts of
  // the full range; not given: from the picture itself.
  std::optional<double> read_noise;
  std::optional<double> noise_gain;
  // Where dots may be: polygons of the camera's picture, each "x:y x:y x:y ...", px. None:
  // everywhere.
  std::vector<std::string> regions;
  int most_dots = 500;  // the clearest ones are kept
};
void VisitOptions(DotDetectorOptions& options, OptionVisitor& visit);
Result<void> CheckOptions(const DotDetectorOptions& options);

// How the last picture went.
struct DotDetectorReport {
  int candidates = 0;  // places that stand out from all around
  int blobs = 0;       // of these, the ones with the size and the shape of a dot
  int refused = 0;     // of these, the ones that the fit did not confirm
  // There was more than `most_dots` allow for, and not all of it was looked at.
  bool too_many = false;
  PixelNoise noise;
};

// Finds the dots of pictures, to the accuracy that the noise of the pixels allows.
//
//   DotDetector detector(options);
//   const std::vector<Dot> dots = detector.Detect(frame.image, frame.picture_from_image);
//
// 1. Every few rows, so many that the smallest dot is met twice, are read once, and compared with
//    themselves to the left, right, above and below at a distance beyond the largest dot's radius:
//    what stands out from at least three of the four is a candidate (dot_scan.h). Edges, slopes of
//    light and large things do not, whatever their brightness.
// 2. Runs of such pixels are joined; around each the pixels above half of the way from what
//    surrounds them to what they have are gathered, and gated by size, roundness and how well an
//    ellipse fills them (dot_blob.h).
// 3. A blurred ellipse is fitted to the pixels of each (dot_fit.h).
//
// Results do not depend on earlier pictures, nor on the instructions of the processor. One thread
// an object; it keeps its scratch.
class DotDetector {
 public:
  // The options have been checked.
  explicit DotDetector(const DotDetectorOptions& options);
  ~DotDetector();
  DotDetector(DotDetector&&) noexcept;
  DotDetector& operator=(DotDetector&&) noexcept;

  // From top to bottom.
  std::vector<Dot> Detect(const ImageView& image, const PictureFromImage& picture_from_image);
  const DotDetectorReport& report() const;

  // For tests: another level than the processor's best.
  void set_simd_level(SimdLevel level);
  SimdLevel simd_level() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace articap
