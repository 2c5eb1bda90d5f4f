// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "render/lens_view.h"
#include "render/render.h"
#include "synthetic/camera_rigs.h"
#include "synthetic/sensor.h"

namespace articap {

// Whether one of a camera's pixels covers a point.
bool IsInPicture(const Camera& camera, const Eigen::Vector2d& point_px);

// What one view shows of some points.
struct ViewTruth {
  View view;
  // Where each point appears, also outside the picture or behind other things; NaN where the view
  // does not look at all.
  std::vector<Eigen::Vector2d> points_px;
  // Whether it is truly to be seen: inside the picture, nothing before it, and within the mirror.
  std::vector<bool> visible;

  bool all_visible() const;
};

// Cameras that take pictures of scenes in the stage frame. Lens tables are made once and kept.
class Studio {
 public:
  // samples_per_side: of a pixel on an edge. Sampling moves a corner of a board by some 0.008 px
  // with 8, below what the noise of a good sensor does, and by 0.02 px with 4, in half the
  // time.
  explicit Studio(SyntheticCameras cameras, int samples_per_side = 8);

  const SyntheticCameras& cameras() const { return cameras_; }
  int num_cameras() const { return static_cast<int>(views_.size()); }
  const LensView& lens_view(int camera) const { return views_.at(camera); }

  // The mirrors and the light of a room, for things to be put in.
  Scene EmptyScene() const;
  // Flat light, without shadows: a board in about a second on one processor.
  LinearPicture Render(const Scene& scene, int camera) const;
  Image Photograph(const Scene& scene, int camera, const SensorOptions& sensor,
                   std::uint64_t seed) const;

  // For every view of the array. Points may lie up to `depth_mm` below the surface that shows
  // them, as the centre of a ball does.
  std::vector<ViewTruth> TruthOf(const Scene& scene, const std::vector<Eigen::Vector3d>& points,
                                 double depth_mm = 0) const;

 private:
  SyntheticCameras cameras_;
  int samples_per_side_;
  std::vector<LensView> views_;
};

}  // namespace articap
