// SPDX-License-Identifier: MIT
#include "render/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <thread>

#include "core/check.h"
#include "render/traced_scene.h"

namespace articap {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// Evenly spread numbers in [0, 1)^2 from an index: the R2 sequence of Roberts (2018), shifted by a
// hash of the pixel so that neighbouring pixels do not share a pattern.
class SampleSequence {
 public:
  // What the numbers are for: 0 for the ambient light, from 1 on for the lamps.
  static constexpr int kInPixel = 15;

  SampleSequence(int x, int y) {
    std::uint32_t hash = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^
                         (static_cast<std::uint32_t>(y) * 0x85EBCA77u + 0x27D4EB2Fu);
    for (float& shift : shift_) {
      hash = (hash ^ (hash >> 15)) * 0x2C1B3C6Du;
      hash = (hash ^ (hash >> 12)) * 0x297A2D39u;
      hash ^= hash >> 15;
      shift = static_cast<float>(hash >> 8) * 0x1p-24f;
    }
  }

  Vector2f Sample(int index, int dimension) const {
    const double x = shift_[(2 * dimension) % kNumShifts] + 0.7548776662466927 * index;
    const double y = shift_[(2 * dimension + 1) % kNumShifts] + 0.5698402909980532 * index;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
  }

 private:
  static constexpr int kNumShifts = 32;
  float shift_[kNumShifts];
};

// Two unit vectors that complete a unit vector to a frame (Duff et al. 2017).
void Complete(const Vector3f& axis, Vector3f& first, Vector3f& second) {
  const float sign = std::copysign(1.0f, axis.z());
  const float a = -1 / (sign + axis.z());
  const float b = axis.x() * axis.y() * a;
  first = Vector3f(1 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x());
  second = Vector3f(b, sign + axis.y() * axis.y() * a, -axis.y());
}

class Shader {
 public:
  Shader(const Scene& scene, const RenderOptions& options)
      : scene_(scene), options_(options), traced_(scene) {}

  // Light that comes back along a ray of sight. index: which of the pixel's samples this is.
  Vector3f Light(const SightRay& ray, const SampleSequence& sequence, int index) const {
    const SightEnd end = traced_.Follow(ray);
    if (!end.surface) return end.transmission * end.color;
    const SurfacePoint& surface = *end.surface;
    Vector3f diffuse = surface.material->glow * Vector3f::Ones();
    diffuse += AmbientLight(surface, sequence.Sample(index, 0));
    Vector3f highlight = Vector3f::Zero();
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
      AddLamp(scene_.lights[i], surface, end.direction,
              sequence.Sample(index, 1 + static_cast<int>(i)), diffuse, highlight);
    return end.transmission * (diffuse.cwiseProduct(surface.color) + highlight);
  }

 private:
  // One cosine-weighted ray decides whether the sample sees the sky. Some light always comes back
  // from the skin around a fold, and more of it red.
  Vector3f AmbientLight(const SurfacePoint& surface, const Vector2f& random) const {
    if (options_.occlusion_mm <= 0) return scene_.ambient;
    const float angle = 2 * std::numbers::pi_v<float> * random.x();
    Vector3f first, second;
    Complete(surface.normal, first, second);
    const float radius = std::sqrt(random.y());
    const Vector3f towards = radius * (std::cos(angle) * first + std::sin(angle) * second) +
                             std::sqrt(std::max(0.0f, 1 - random.y())) * surface.normal;
    if (!traced_.IsBlocked(surface.start_mm, towards, static_cast<float>(options_.occlusion_mm)))
      return scene_.ambient;
    return surface.material->translucence *
           scene_.ambient.cwiseProduct(Vector3f(0.35f, 0.2f, 0.16f));
  }

  // A direction to a point of the lamp's disc.
  static Vector3f TowardsLamp(const DirectionalLight& light, const Vector2f& random) {
    const Vector3f axis = light.towards_light.normalized().cast<float>();
    if (light.angular_radius_rad == 0) return axis;
    Vector3f first, second;
    Complete(axis, first, second);
    const float radius =
        std::sqrt(random.x()) * static_cast<float>(std::tan(light.angular_radius_rad));
    const float angle = 2 * std::numbers::pi_v<float> * random.y();
    return (axis + radius * (std::cos(angle) * first + std::sin(angle) * second)).normalized();
  }

  void AddLamp(const DirectionalLight& light, const SurfacePoint& surface,
               const Vector3f& direction, const Vector2f& random, Vector3f& diffuse,
               Vector3f& highlight) const {
    const Vector3f towards = TowardsLamp(light, random);
    const float cosine = surface.normal.dot(towards);
    // Wrapped Lambert: how far light reaches beyond the terminator, per channel.
    const Vector3f wrap = surface.material->translucence * Vector3f(0.35f, 0.16f, 0.10f);
    const Vector3f lambert =
        ((Vector3f::Constant(cosine) + wrap).array() / (1 + wrap.array()).square())
            .max(0.0f)
            .matrix();
    if (lambert.x() <= 0) return;
    if (options_.shadows && traced_.IsBlocked(surface.start_mm, towards)) return;
    diffuse += light.radiance.cwiseProduct(lambert);
    if (cosine <= 0 || surface.material->gloss <= 0) return;
    const Vector3f halfway = (towards - direction).normalized();
    // Schlick's Fresnel term at 4 % normal reflectance, scaled so that gloss 1 is a wet surface.
    const float grazing = std::pow(1 - std::max(0.0f, halfway.dot(towards)), 5.0f);
    const float fresnel = 0.04f + 0.96f * grazing;
    const float shininess = surface.material->shininess;
    const float lobe =
        (shininess + 8) / 8 * std::pow(std::max(0.0f, surface.normal.dot(halfway)), shininess);
    highlight += surface.material->gloss * fresnel * lobe * cosine * light.radiance;
  }

  const Scene& scene_;
  const RenderOptions& options_;
  TracedScene traced_;
};

// Where in its pixel each sample lies, in [-0.5, 0.5)^2: one in every cell, and in every one of the
// rows and columns that are as many as the samples (Chiu, Shirley and Wang, "Multi-jittered
// sampling", 1994), the whole shifted around the pixel at random. So an edge is placed without
// bias, also one along a row or a column of pixels. A single sample is the middle.
Eigen::Vector2d PlaceInPixel(int row, int column, int per_side, const Vector2f& shift) {
  if (per_side == 1) return Eigen::Vector2d::Zero();
  const double x = shift.x() + (column + (row + 0.5) / per_side) / per_side;
  const double y = shift.y() + (row + (column + 0.5) / per_side) / per_side;
  return {x - std::floor(x) - 0.5, y - std::floor(y) - 0.5};
}

// Renders rows of a picture; knows how many samples a pixel needs.
class PixelSampler {
 public:
  PixelSampler(const Scene& scene, const ViewCamera& camera, const RenderOptions& options)
      : scene_(scene), camera_(camera), options_(options), shader_(scene, options) {}

  // What the middle of a pixel sees.
  Vector3f Middle(int x, int y) const {
    return LightAt(Eigen::Vector2d(x, y), SampleSequence(x, y), 0);
  }

  Vector3f Average(int x, int y) const {
    const SampleSequence sequence(x, y);
    const Vector2f shift = sequence.Sample(0, SampleSequence::kInPixel);
    Vector3f sum = Vector3f::Zero();
    int index = 0;
    for (int row = 0; row < options_.samples_per_side; ++row)
      for (int column = 0; column < options_.samples_per_side; ++column, ++index)
        sum += LightAt(
            Eigen::Vector2d(x, y) + PlaceInPixel(row, column, options_.samples_per_side, shift),
            sequence, index);
    return sum / static_cast<float>(index);
  }

 private:
  Vector3f LightAt(const Eigen::Vector2d& point_px, const SampleSequence& sequence,
                   int index) const {
    const auto ray = camera_.RayThrough(point_px);
    return ray ? shader_.Light(*ray, sequence, index) : scene_.background;
  }

  const Scene& scene_;
  const ViewCamera& camera_;
  const RenderOptions& options_;
  Shader shader_;
};

// Whether a pixel and its eight neighbours differ by less than this in every colour. At the border
// of the picture, where not all are there, they count as different.
bool IsUniform(const LinearPicture& middles, int x, int y, double less_than) {
  if (x == 0 || y == 0 || x == middles.width - 1 || y == middles.height - 1) return false;
  const Vector3f& middle = middles.rgb[static_cast<std::size_t>(y) * middles.width + x];
  for (int row = y - 1; row <= y + 1; ++row)
    for (int column = x - 1; column <= x + 1; ++column) {
      const Vector3f& other = middles.rgb[static_cast<std::size_t>(row) * middles.width + column];
      if (!((other - middle).cwiseAbs().maxCoeff() < less_than)) return false;
    }
  return true;
}

// Calls fill_row(y) for every row of a picture, in several threads.
template <class FillRow>
void ForEachRow(int height, int num_threads, const FillRow& fill_row) {
  std::atomic<int> next_row = 0;
  const auto fill_rows = [&] {
    for (int y = next_row++; y < height; y = next_row++) fill_row(y);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < num_threads; ++i) helpers.emplace_back(fill_rows);
  fill_rows();
}

}  // namespace

std::vector<DirectionalLight> PortraitLights() {
  return {{{0.55, 0.75, 0.95}, {0.98f, 0.93f, 0.86f}, 0.16},
          {{-0.9, 0.15, 0.8}, {0.25f, 0.265f, 0.29f}, 0.25},
          {{-0.6, 0.7, -0.8}, {0.42f, 0.43f, 0.45f}, 0.12}};
}

LinearPicture RenderLinear(const Scene& scene, const ViewCamera& camera,
                           const RenderOptions& options) {
  ARTICAP_CHECK_GT(options.samples_per_side, 0);
  const int width = camera.width();
  const int height = camera.height();
  ARTICAP_CHECK(width > 0 && height > 0);
  const PixelSampler sampler(scene, camera, options);
  LinearPicture middles{width, height, {}};
  if (options.one_sample_below > 0) {
    middles.rgb.resize(static_cast<std::size_t>(width) * height);
    ForEachRow(height, options.num_threads, [&](int y) {
      for (int x = 0; x < width; ++x)
        middles.rgb[static_cast<std::size_t>(y) * width + x] = sampler.Middle(x, y);
    });
  }
  LinearPicture picture{width, height, {}};
  picture.rgb.resize(static_cast<std::size_t>(width) * height);
  ForEachRow(height, options.num_threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      const bool enough =
          options.one_sample_below > 0 && IsUniform(middles, x, y, options.one_sample_below);
      picture.rgb[pixel] = enough ? middles.rgb[pixel] : sampler.Average(x, y);
    }
  });
  return picture;
}

Picture Render(const Scene& scene, const ViewCamera& camera, const RenderOptions& options) {
  return EncodeSrgb(RenderLinear(scene, camera, options));
}

}  // namespace articap
