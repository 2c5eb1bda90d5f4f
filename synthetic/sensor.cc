// SPDX-License-Identifier: MIT
#include "synthetic/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/check.h"
#include "synthetic/random.h"
#include "synthetic/random_streams.h"

namespace articap {
namespace {

// One colour of a picture.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<float> light;

  float& at(int x, int y) { return light[static_cast<std::size_t>(y) * width + x]; }
  // Beyond its border a picture goes on as it ends.
  float Nearest(int x, int y) const {
    const int column = std::clamp(x, 0, width - 1);
    const int row = std::clamp(y, 0, height - 1);
    return light[static_cast<std::size_t>(row) * width + column];
  }
};

// A weight for each pixel around one, in a square of 2 reach + 1 pixels.
struct Kernel {
  int reach_x = 0;
  int reach_y = 0;
  std::vector<float> weights;

  void Normalise() {
    float sum = 0;
    for (const float weight : weights) sum += weight;
    for (float& weight : weights) weight /= sum;
  }
};

Kernel GaussianKernel(double sigma_px, bool across) {
  const int reach = static_cast<int>(std::ceil(4 * sigma_px));
  Kernel kernel{across ? reach : 0, across ? 0 : reach, {}};
  for (int i = -reach; i <= reach; ++i)
    kernel.weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
  kernel.Normalise();
  return kernel;
}

// How much of each pixel a disc covers.
Kernel DiscKernel(double radius_px) {
  constexpr int kPoints = 16;  // a side of a pixel
  const int reach = static_cast<int>(std::ceil(radius_px + 0.5));
  Kernel kernel{reach, reach, {}};
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      int covered = 0;
      for (int row = 0; row < kPoints; ++row)
        for (int column = 0; column < kPoints; ++column)
          covered += std::hypot(x - 0.5 + (column + 0.5) / kPoints,
                                y - 0.5 + (row + 0.5) / kPoints) <= radius_px;
      kernel.weights.push_back(static_cast<float>(covered));
    }
  kernel.Normalise();
  return kernel;
}

Plane Convolve(const Plane& plane, const Kernel& kernel) {
  Plane result{plane.width, plane.height, std::vector<float>(plane.light.size())};
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const bool inside = x >= kernel.reach_x && x + kernel.reach_x < plane.width;
      const float* weight = kernel.weights.data();
      float sum = 0;
      for (int row = y - kernel.reach_y; row <= y + kernel.reach_y; ++row) {
        if (inside) {
          const int nearest_row = std::clamp(row, 0, plane.height - 1);
          const float* light =
              &plane.light[static_cast<std::size_t>(nearest_row) * plane.width + x];
          for (int i = -kernel.reach_x; i <= kernel.reach_x; ++i) sum += *weight++ * light[i];
        } else {
          for (int i = -kernel.reach_x; i <= kernel.reach_x; ++i)
            sum += *weight++ * plane.Nearest(x + i, row);
        }
      }
      result.at(x, y) = sum;
    }
  return result;
}

// What the lens does to the light.
void Blur(const SensorOptions& options, Plane& plane) {
  if (options.defocus_px > 0) plane = Convolve(plane, DiscKernel(options.defocus_px));
  if (options.blur_px <= 0) return;
  plane = Convolve(plane, GaussianKernel(options.blur_px, true));
  plane = Convolve(plane, GaussianKernel(options.blur_px, false));
}

// Light falls off with the square of the distance from the middle, as cos^4 does at first.
void Vignette(double corner_loss, Plane& plane) {
  if (corner_loss <= 0) return;
  const double middle_x = 0.5 * (plane.width - 1), middle_y = 0.5 * (plane.height - 1);
  const double corner2 = std::max(1.0, middle_x * middle_x + middle_y * middle_y);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const double dx = x - middle_x, dy = y - middle_y;
      plane.at(x, y) *= static_cast<float>(1 - corner_loss * (dx * dx + dy * dy) / corner2);
    }
}

// From light to the part of the output's range, 0 to 1.
double Digitise(double light, const SensorOptions& options, RandomGenerator& random) {
  double electrons = std::max(0.0, light) * options.exposure * options.full_well_e;
  if (options.noise) electrons = random.Poisson(electrons);
  electrons = std::min(electrons, options.full_well_e);
  if (options.noise) electrons += options.read_noise_e * random.Normal();
  const double signal =
      options.black_level + (1 - options.black_level) * electrons / options.full_well_e;
  const double part = std::clamp(signal, 0.0, 1.0);
  if (options.tone == ToneCurve::kLinear) return part;
  return part <= 0.0031308 ? 12.92 * part : 1.055 * std::pow(part, 1 / 2.4) - 0.055;
}

std::vector<Plane> PlanesOf(const LinearPicture& picture, PixelFormat format) {
  const auto plane_of = [&](const Eigen::Vector3f& weights) {
    Plane plane{picture.width, picture.height, {}};
    plane.light.reserve(picture.rgb.size());
    for (const Eigen::Vector3f& light : picture.rgb) plane.light.push_back(weights.dot(light));
    return plane;
  };
  // A grey sensor sees what people do: the weights of ITU-R BT.709.
  if (format != PixelFormat::kRgb8) return {plane_of({0.2126f, 0.7152f, 0.0722f})};
  return {plane_of(Eigen::Vector3f::UnitX()), plane_of(Eigen::Vector3f::UnitY()),
          plane_of(Eigen::Vector3f::UnitZ())};
}

}  // namespace

void VisitOptions(SensorOptions& options, OptionVisitor& visit) {
  visit.Enumeration("format", options.format, {"gray8", "gray16", "rgb8"}, "what a pixel holds");
  visit("blur_px", options.blur_px, "SD of the lens' Gaussian blur; px");
  visit("defocus_px", options.defocus_px, "radius of what a point out of focus becomes; px");
  visit("vignetting", options.vignetting, "part of the light that the farthest corner loses");
  visit("exposure", options.exposure, "part of the range that the brightest white fills");
  visit("noise", options.noise, "of photons and of reading out");
  visit("full_well_e", options.full_well_e, "electrons that fill a pixel");
  visit("read_noise_e", options.read_noise_e, "SD of the noise of reading out; electrons");
  visit("black_level", options.black_level, "part of the range that shows without light");
  visit.Enumeration("tone", options.tone, {"linear", "srgb"}, "machine vision's, or a camcorder's");
}

Result<void> CheckOptions(const SensorOptions& options) {
  if (auto positive = RequirePositive({{"sensor_full_well_e", options.full_well_e}}); !positive)
    return positive;
  if (auto valid = RequireNotNegative({{"sensor_blur_px", options.blur_px},
                                       {"sensor_defocus_px", options.defocus_px},
                                       {"sensor_exposure", options.exposure},
                                       {"sensor_read_noise_e", options.read_noise_e}});
      !valid)
    return valid;
  if (!(options.vignetting >= 0 && options.vignetting <= 1))
    return Fail(
        fmt::format("sensor_vignetting is {}; it must be between 0 and 1", options.vignetting));
  if (!(options.black_level >= 0 && options.black_level < 1))
    return Fail(fmt::format("sensor_black_level is {}; it must be at least 0 and below 1",
                            options.black_level));
  return {};
}

Image Expose(const LinearPicture& light, const SensorOptions& options, std::uint64_t seed) {
  ARTICAP_CHECK(options.full_well_e > 0 && options.exposure >= 0);
  ARTICAP_CHECK(options.black_level >= 0 && options.black_level < 1);
  std::vector<Plane> planes = PlanesOf(light, options.format);
  for (Plane& plane : planes) {
    Blur(options, plane);
    Vignette(options.vignetting, plane);
  }
  RandomGenerator random(seed, random_streams::kSensor);
  Image image(options.format, light.width, light.height);
  std::uint8_t* byte = image.bytes.data();
  for (std::size_t pixel = 0; pixel < light.rgb.size(); ++pixel)
    for (const Plane& plane : planes) {
      const double part = Digitise(plane.light[pixel], options, random);
      if (options.format == PixelFormat::kGray16) {
        const auto value = static_cast<std::uint16_t>(std::lround(65535 * part));
        std::memcpy(byte, &value, sizeof(value));
        byte += sizeof(value);
      } else {
        *byte++ = static_cast<std::uint8_t>(std::lround(255 * part));
      }
    }
  return image;
}

LinearPicture MotionBlur(int num_instants,
                         const std::function<LinearPicture(double part)>& render_at) {
  ARTICAP_CHECK_GT(num_instants, 0);
  LinearPicture mean = render_at(0.5 / num_instants);
  for (int instant = 1; instant < num_instants; ++instant) {
    const LinearPicture next = render_at((instant + 0.5) / num_instants);
    ARTICAP_CHECK(next.width == mean.width && next.height == mean.height);
    for (std::size_t i = 0; i < mean.rgb.size(); ++i) mean.rgb[i] += next.rgb[i];
  }
  for (Eigen::Vector3f& light : mean.rgb) light /= static_cast<float>(num_instants);
  return mean;
}

}  // namespace articap
