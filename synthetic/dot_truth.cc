// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/traced_scene.h"
#include "synthetic/speaker_scene.h"

namespace articap {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
// Smaller steps of linear light than this are less than the noise of a good sensor.
constexpr double kEven = 0.004;
// Beyond a dot's outline, so that the pixels on it and their neighbours are within a spot.
constexpr double kAround_px = 2.5;

// A dot's outline: the sticker's own, or the circle of a ball that a view sees it by.
struct Outline {
  Eigen::Vector3d center_mm;
  Eigen::Vector3d across_mm;  // as long as the radius, at right angles with up_mm
  Eigen::Vector3d up_mm;

  Eigen::Vector3d At(double part_of_radius, double angle_rad) const {
    return center_mm +
           part_of_radius * (std::cos(angle_rad) * across_mm + std::sin(angle_rad) * up_mm);
  }
};

Outline OutlineOf(const CameraArray& array, const View& view, const SpeakerScene& filmed, int dot) {
  const Eigen::Vector3d& center_mm = filmed.center_mm(dot);
  const Eigen::Vector3d axis = filmed.scene.discs.empty()
                                   ? Eigen::Vector3d((EyeOf(array, view) - center_mm).normalized())
                                   : filmed.scene.discs[dot].normal;
  const Eigen::Vector3d across = axis.unitOrthogonal();
  return {center_mm, filmed.radius_mm(dot) * across, filmed.radius_mm(dot) * axis.cross(across)};
}

// The outline in the picture; empty where not all of it is before the camera.
std::vector<Eigen::Vector2d> ProjectOutline(const CameraArray& array, const View& view,
                                            const Outline& outline) {
  constexpr int kPoints = 48;
  std::vector<Eigen::Vector2d> points_px;
  for (int i = 0; i < kPoints; ++i) {
    const auto point_px = Project(array, view, outline.At(1, kTurn_rad * i / kPoints));
    if (!point_px) return {};
    points_px.push_back(*point_px);
  }
  return points_px;
}

// Of the disc with a polygon's area; the polygon's points lie on an ellipse, whose area is larger
// by the same factor as a circle's is.
double DiameterOf(const std::vector<Eigen::Vector2d>& points_px) {
  double twice_area_px2 = 0;
  for (std::size_t i = 0; i < points_px.size(); ++i) {
    const Eigen::Vector2d& next_px = points_px[(i + 1) % points_px.size()];
    twice_area_px2 += points_px[i].x() * next_px.y() - points_px[i].y() * next_px.x();
  }
  const double angle_rad = kTurn_rad / static_cast<double>(points_px.size());
  const double ellipse_over_polygon = angle_rad / std::sin(angle_rad);
  return std::sqrt(2 / std::numbers::pi * std::abs(twice_area_px2) * ellipse_over_polygon);
}

// Whether the picture shows a dot at a point of its outline's inside.
bool Shows(const Studio& studio, const TracedScene& traced, const View& view, int dot,
           const Eigen::Vector3d& point_mm) {
  const CameraArray& array = studio.cameras().array;
  const auto point_px = Project(array, view, point_mm);
  if (!point_px || !IsInPicture(array.cameras[view.camera], *point_px)) return false;
  const auto ray = studio.lens_view(view.camera).RayThrough(*point_px);
  if (!ray) return false;
  const SightEnd end = traced.Follow(*ray);
  return end.surface && end.IsBy(view.mirror) &&
         (end.surface->disc == dot || end.surface->sphere == dot);
}

// The part of a dot's outline that is seen, by points spread evenly over it (Vogel 1979).
double VisiblePart(const Studio& studio, const TracedScene& traced, const View& view, int dot,
                   const Outline& outline) {
  constexpr int kPoints = 100;
  const double golden_angle_rad = kTurn_rad * (2 - std::numbers::phi);
  int seen = 0;
  for (int i = 0; i < kPoints; ++i)
    seen += Shows(studio, traced, view, dot,
                  outline.At(std::sqrt((i + 0.5) / kPoints), golden_angle_rad * i));
  return static_cast<double>(seen) / kPoints;
}

}  // namespace

Eigen::Vector3d EyeOf(const CameraArray& array, const View& view) {
  const Eigen::Vector3d eye_mm = array.cameras[view.camera].cam_from_stage.Inverse().translation_mm;
  return view.mirror < 0 ? eye_mm : array.mirrors[view.mirror].Reflect(eye_mm);
}

std::vector<std::vector<DotTruth>> TruthOfDots(const Studio& studio, const SpeakerScene& filmed) {
  const CameraArray& array = studio.cameras().array;
  const TracedScene traced(filmed.scene);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<DotTruth>> of_views;
  for (const View& view : array.views()) {
    std::vector<DotTruth>& truths = of_views.emplace_back();
    for (int dot = 0; dot < filmed.num_dots; ++dot) {
      const Outline outline = OutlineOf(array, view, filmed, dot);
      const std::vector<Eigen::Vector2d> outline_px = ProjectOutline(array, view, outline);
      const auto center_px = Project(array, view, outline.center_mm);
      if (!center_px || outline_px.empty()) {
        truths.push_back({Eigen::Vector2d::Constant(unknown), 0, unknown});
        continue;
      }
      truths.push_back(
          {*center_px, VisiblePart(studio, traced, view, dot, outline), DiameterOf(outline_px)});
    }
  }
  return of_views;
}

LinearPicture RenderSpeaker(const Studio& studio, const SpeakerScene& filmed, int camera,
                            const PictureRows& rows) {
  RenderOptions options = {.samples_per_side = 3,
                           .one_sample_below = kEven,
                           .step_px = 4,
                           .samples_per_side_in_spots = 12,
                           .first_row = rows.begin,
                           .end_row = rows.end,
                           .occlusion_mm = 0,
                           .shadows = true,
                           .num_threads = 1};
  const CameraArray& array = studio.cameras().array;
  for (const View& view : array.views()) {
    if (view.camera != camera) continue;
    for (int dot = 0; dot < filmed.num_dots; ++dot) {
      PictureSpot spot;
      const Outline outline = OutlineOf(array, view, filmed, dot);
      const auto center_px = Project(array, view, outline.center_mm);
      if (!center_px) continue;
      spot.center_px = *center_px;
      for (const Eigen::Vector2d& point_px : ProjectOutline(array, view, outline))
        spot.radius_px = std::max(spot.radius_px, (point_px - *center_px).norm() + kAround_px);
      options.spots.push_back(spot);
    }
  }
  return RenderLinear(filmed.scene, studio.lens_view(camera), options);
}

}  // namespace articap
