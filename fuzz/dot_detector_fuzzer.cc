// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "fuzz/fuzz_input.h"
#include "tracking/dot_detector.h"

namespace {

// A detector of any kind: the first bytes choose.
articap::DotDetectorOptions OptionsOf(std::uint8_t choice, std::uint8_t size) {
  articap::DotDetectorOptions options;
  options.polarity =
      (choice & 1) != 0 ? articap::DotPolarity::kDark : articap::DotPolarity::kBright;
  options.tone = (choice & 2) != 0 ? articap::DotTone::kSrgb : articap::DotTone::kLinear;
  if ((choice & 4) != 0) options.color = "#30a0e0";
  if ((choice & 8) != 0) options.regions = {"1:1 30:2 20:40"};
  if ((choice & 16) != 0) options.min_contrast = 0.01;
  options.min_diameter_px = 2 + size % 8;
  options.max_diameter_px = options.min_diameter_px + size;
  options.most_dots = 1 + size;
  return options;
}

}  // namespace

// Any bytes are a picture. What is found in them is finite, and lies where it can.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using articap::Require;
  constexpr std::size_t kHead = 5;
  if (size < kHead) return 0;
  const articap::DotDetectorOptions options = OptionsOf(data[0], data[1]);
  Require(articap::CheckOptions(options).has_value());
  articap::ImageView image;
  image.format = static_cast<articap::PixelFormat>(data[2] % 3);
  image.width = 1 + data[3];
  const std::ptrdiff_t length =
      static_cast<std::ptrdiff_t>(image.width) * articap::BytesPerPixel(image.format);
  image.stride_bytes = length + data[4] % 4;
  image.data = data + kHead;
  const auto rest = static_cast<std::ptrdiff_t>(size - kHead);
  if (rest < length) return 0;
  image.height = static_cast<int>((rest - length) / image.stride_bytes + 1);
  articap::PictureFromImage picture_from_image;
  if ((data[0] & 32) != 0) picture_from_image.scale = {1, 2};

  articap::DotDetector detector(options);
  const std::vector<articap::Dot> dots = detector.Detect(image, picture_from_image);
  Require(static_cast<int>(dots.size()) <= options.most_dots);
  const double reach_px = 2 * options.max_diameter_px;
  for (const articap::Dot& dot : dots) {
    Require(dot.center_px.allFinite() && dot.covariance_px2.allFinite());
    Require(dot.covariance_px2.diagonal().minCoeff() > 0);
    Require(dot.center_px.minCoeff() > -reach_px);
    Require(dot.center_px.x() < image.width + reach_px);
    Require(dot.center_px.y() < 2 * image.height + reach_px);
    Require(dot.diameter_px() >= options.min_diameter_px - 1e-6);
    Require(dot.diameter_px() <= options.max_diameter_px + 1e-6);
  }
  detector.set_simd_level(articap::SimdLevel::kNone);
  const std::vector<articap::Dot> plain = detector.Detect(image, picture_from_image);
  Require(plain.size() == dots.size());
  for (std::size_t i = 0; i < dots.size(); ++i) Require(plain[i].center_px == dots[i].center_px);
  return 0;
}
