// SPDX-License-Identifier: MIT
#include "synthetic/studio.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "render/traced_scene.h"

namespace articap {
namespace {

// Surfaces are kept in float32, and mirrors lengthen the way.
constexpr double kSamePlace_mm = 0.02;
// Smaller differences between neighbouring pixels are none to 8 bits.
constexpr double kPlain = 0.002;

// Whether a ray of sight comes to a point by way of the view's mirror, and of no other.
bool Reaches(const TracedScene& traced, const SightRay& ray, const View& view,
             const Eigen::Vector3d& point_mm, double depth_mm) {
  const SightEnd end = traced.Follow(ray);
  if (!end.surface || !end.IsBy(view.mirror)) return false;
  const double away_mm = (end.surface->position_mm.cast<double>() - point_mm).norm();
  return away_mm <= depth_mm + kSamePlace_mm;
}

}  // namespace

bool IsInPicture(const Camera& camera, const Eigen::Vector2d& point_px) {
  return point_px.x() >= -0.5 && point_px.y() >= -0.5 && point_px.x() < camera.width - 0.5 &&
         point_px.y() < camera.height - 0.5;
}

bool ViewTruth::all_visible() const {
  return std::all_of(visible.begin(), visible.end(), [](bool is_visible) { return is_visible; });
}

Studio::Studio(SyntheticCameras cameras, int samples_per_side)
    : cameras_(std::move(cameras)), samples_per_side_(samples_per_side) {
  for (const Camera& camera : cameras_.array.cameras) views_.emplace_back(camera);
}

Scene Studio::EmptyScene() const {
  Scene scene;
  scene.mirrors = cameras_.RenderMirrors();
  scene.lights = {{{0.3, 0.6, 1}, Eigen::Vector3f::Constant(0.5f), 0}};
  scene.ambient = Eigen::Vector3f::Constant(0.35f);
  scene.background = Eigen::Vector3f::Constant(0.18f);
  return scene;
}

LinearPicture Studio::Render(const Scene& scene, int camera) const {
  return RenderLinear(scene, lens_view(camera),
                      {.samples_per_side = samples_per_side_,
                       .one_sample_below = kPlain,
                       .occlusion_mm = 0,
                       .shadows = false});
}

Image Studio::Photograph(const Scene& scene, int camera, const SensorOptions& sensor,
                         std::uint64_t seed) const {
  return Expose(Render(scene, camera), sensor, seed);
}

std::vector<ViewTruth> Studio::TruthOf(const Scene& scene,
                                       const std::vector<Eigen::Vector3d>& points,
                                       double depth_mm) const {
  const TracedScene traced(scene);
  const Eigen::Vector2d nowhere =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<ViewTruth> truths;
  for (const View& view : cameras_.array.views()) {
    ViewTruth& truth = truths.emplace_back();
    truth.view = view;
    for (const Eigen::Vector3d& point_mm : points) {
      const auto point_px = Project(cameras_.array, view, point_mm);
      truth.points_px.push_back(point_px.value_or(nowhere));
      const bool is_inside =
          point_px && IsInPicture(cameras_.array.cameras[view.camera], *point_px);
      const auto ray = is_inside ? lens_view(view.camera).RayThrough(*point_px) : std::nullopt;
      truth.visible.push_back(ray && Reaches(traced, *ray, view, point_mm, depth_mm));
    }
  }
  return truths;
}

}  // namespace articap
