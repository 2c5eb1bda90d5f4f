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
    if (cosine <= 0) return;
    const Vector3f halfway = (towards - direction).normalized();
    if (surface.disc < 0 && surface.sphere < 0)
      for (const RenderWetSpot& wet : scene_.wet_spots)
        highlight += wet.ShineAt(surface.position_mm, surface.normal, halfway) * light.radiance;
    if (surface.material->gloss <= 0) return;
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

// What pixels see.
class PixelSampler {
 public:
  PixelSampler(const Scene& scene, const ViewCamera& camera, const RenderOptions& options)
      : scene_(scene), camera_(camera), shader_(scene, options) {}

  // What the middle of a pixel sees.
  Vector3f Middle(int x, int y) const {
    return LightAt(Eigen::Vector2d(x, y), SampleSequence(x, y), 0);
  }

  // The mean over a pixel, of the square of so many samples.
  Vector3f Average(int x, int y, int samples_per_side) const {
    const SampleSequence sequence(x, y);
    const Vector2f shift = sequence.Sample(0, SampleSequence::kInPixel);
    Vector3f sum = Vector3f::Zero();
    int index = 0;
    for (int row = 0; row < samples_per_side; ++row)
      for (int column = 0; column < samples_per_side; ++column, ++index)
        sum += LightAt(Eigen::Vector2d(x, y) + PlaceInPixel(row, column, samples_per_side, shift),
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
  Shader shader_;
};

// Whether a pixel is less than this off halfway between its neighbours `step_px` to either side, in
// every colour and in all four directions. At the border of the picture, where not all are there,
// it counts as off.
bool IsEven(const LinearPicture& middles, int x, int y, int step_px, double less_than) {
  if (x < step_px || y < step_px || x >= middles.width - step_px || y >= middles.height - step_px)
    return false;
  const auto at = [&](int column, int row) -> const Vector3f& {
    return middles.rgb[static_cast<std::size_t>(row) * middles.width + column];
  };
  const Vector3f& middle = at(x, y);
  for (const auto& [across, down] :
       {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1), std::pair(1, -1)}) {
    const Vector3f& before = at(x - step_px * across, y - step_px * down);
    const Vector3f& behind = at(x + step_px * across, y + step_px * down);
    if (!((0.5f * (before + behind) - middle).cwiseAbs().maxCoeff() < less_than)) return false;
  }
  return true;
}

// Rows of a picture, or of the nodes in it; the end is excluded.
struct RowRange {
  int begin = 0;
  int end = 0;
};

// Calls fill_row(y) for every row, in several threads.
template <class FillRow>
void ForEachRow(const RowRange& rows, int num_threads, const FillRow& fill_row) {
  std::atomic<int> next_row = rows.begin;
  const auto fill_rows = [&] {
    for (int y = next_row++; y < rows.end; y = next_row++) fill_row(y);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < num_threads; ++i) helpers.emplace_back(fill_rows);
  fill_rows();
}

// Whether each pixel of a picture is in one of the spots.
std::vector<std::uint8_t> MaskOf(const std::vector<PictureSpot>& spots, int width, int height) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(width) * height, 0);
  for (const PictureSpot& spot : spots) {
    const auto first = [&](double center_px) {
      return static_cast<int>(std::max(0.0, std::ceil(center_px - spot.radius_px)));
    };
    const auto last = [&](double center_px, int size) {
      return static_cast<int>(std::min(size - 1.0, std::floor(center_px + spot.radius_px)));
    };
    for (int y = first(spot.center_px.y()); y <= last(spot.center_px.y(), height); ++y)
      for (int x = first(spot.center_px.x()); x <= last(spot.center_px.x(), width); ++x)
        if ((Eigen::Vector2d(x, y) - spot.center_px).norm() <= spot.radius_px)
          mask[static_cast<std::size_t>(y) * width + x] = 1;
  }
  return mask;
}

// What the middles of pixels see, of which few are looked at where a picture is even.
class MiddleFinder {
 public:
  MiddleFinder(const PixelSampler& sampler, const RenderOptions& options,
               const std::vector<std::uint8_t>& in_spot, LinearPicture& middles)
      : sampler_(sampler), options_(options), in_spot_(in_spot), middles_(middles) {}

  // For rows of pixels and their neighbours: first the pixels on every so-manieth row and column,
  // two such rows farther than they are asked for; then those between.
  void Fill(const RowRange& rows) const {
    const int step = options_.step_px;
    const RowRange cells = Within(rows.begin - 1, rows.end + 1);
    const RowRange nodes = Within(rows.begin - 1 - step, rows.end + 1 + 2 * step);
    ForEachRow(nodes, options_.num_threads, [&](int node_row) {
      for (int x = 0; x < middles_.width; x += step) Look(x, node_row * step);
    });
    if (step == 1) return;
    ForEachRow(cells, options_.num_threads, [&](int node_row) {
      for (int x = 0; x < middles_.width; x += step) FillCell(x, node_row * step);
    });
  }

 private:
  Vector3f& at(int x, int y) const {
    return middles_.rgb[static_cast<std::size_t>(y) * middles_.width + x];
  }
  void Look(int x, int y) const { at(x, y) = sampler_.Middle(x, y); }

  // The rows of nodes, and of the cells below them, that have these rows of pixels.
  RowRange Within(int first_row, int end_row) const {
    const int step = options_.step_px;
    return {std::max(0, first_row) / step, (std::min(middles_.height, end_row) + step - 1) / step};
  }

  bool IsEvenCell(int left, int top) const {
    const int step = options_.step_px;
    for (int y = top; y <= top + step; ++y)
      for (int x = left; x <= left + step; ++x)
        if (x >= middles_.width || y >= middles_.height ||
            in_spot_[static_cast<std::size_t>(y) * middles_.width + x] != 0)
          return false;
    for (const int y : {top, top + step})
      for (const int x : {left, left + step})
        if (!IsEven(middles_, x, y, step, options_.one_sample_below)) return false;
    return true;
  }

  // The pixels from a node up to the next ones.
  void FillCell(int left, int top) const {
    const int step = options_.step_px;
    const bool even = IsEvenCell(left, top);
    for (int y = top; y < std::min(top + step, middles_.height); ++y)
      for (int x = left; x < std::min(left + step, middles_.width); ++x) {
        if (x == left && y == top) continue;
        if (!even) {
          Look(x, y);
          continue;
        }
        const float right = static_cast<float>(x - left) / static_cast<float>(step);
        const float below = static_cast<float>(y - top) / static_cast<float>(step);
        at(x, y) =
            (1 - below) * ((1 - right) * at(left, top) + right * at(left + step, top)) +
            below * ((1 - right) * at(left, top + step) + right * at(left + step, top + step));
      }
  }

  const PixelSampler& sampler_;
  const RenderOptions& options_;
  const std::vector<std::uint8_t>& in_spot_;
  LinearPicture& middles_;
};

// Looks at a pixel as often as it needs.
LinearPicture RenderAdaptively(const PixelSampler& sampler, const RenderOptions& options, int width,
                               int height, const RowRange& rows) {
  const std::vector<std::uint8_t> in_spot = MaskOf(options.spots, width, height);
  LinearPicture middles{width, height, std::vector<Vector3f>(in_spot.size())};
  const MiddleFinder finder(sampler, options, in_spot, middles);
  finder.Fill(rows);
  LinearPicture picture{width, height, std::vector<Vector3f>(in_spot.size(), Vector3f::Zero())};
  ForEachRow(rows, options.num_threads, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      picture.rgb[pixel] = middles.rgb[pixel];
      if (IsEven(middles, x, y, 1, options.one_sample_below)) continue;
      picture.rgb[pixel] = sampler.Average(
          x, y, in_spot[pixel] != 0 ? options.samples_per_side_in_spots : options.samples_per_side);
    }
  });
  return picture;
}

}  // namespace

float RenderWetSpot::ShineAt(const Vector3f& position_mm, const Vector3f& normal,
                             const Vector3f& halfway) const {
  const auto part = static_cast<float>((position_mm.cast<double>() - center_mm).norm() / radius_mm);
  if (part >= 1) return 0;
  const float left = 1 - part * part;
  return gloss * left * std::pow(std::max(0.0f, normal.dot(halfway)), shininess);
}

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
  ARTICAP_CHECK(options.step_px > 0 && options.samples_per_side_in_spots > 0);
  const PixelSampler sampler(scene, camera, options);
  const RowRange rows{std::max(0, options.first_row), std::min(height, options.end_row)};
  if (options.one_sample_below > 0) return RenderAdaptively(sampler, options, width, height, rows);
  const std::size_t num_pixels = static_cast<std::size_t>(width) * height;
  LinearPicture picture{width, height, std::vector<Vector3f>(num_pixels, Vector3f::Zero())};
  ForEachRow(rows, options.num_threads, [&](int y) {
    for (int x = 0; x < width; ++x)
      picture.rgb[static_cast<std::size_t>(y) * width + x] =
          sampler.Average(x, y, options.samples_per_side);
  });
  return picture;
}

Picture Render(const Scene& scene, const ViewCamera& camera, const RenderOptions& options) {
  return EncodeSrgb(RenderLinear(scene, camera, options));
}

}  // namespace articap
