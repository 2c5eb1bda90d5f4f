// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/picture_region.h"
#include "core/transforms.h"

namespace articap {

// The camera frame: origin at the centre of projection, x to the right of the picture, y down, z
// ahead; mm. Pixels: the centre of the top left one is at (0, 0).

// A pinhole with Brown's distortion, in OpenCV's order and sign. With x = X/Z, y = Y/Z, r2 = x2 +
// y2:
//   radial = (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4 r2 + k5 r4 + k6 r6)
//   x' = x radial + 2 p1 x y + p2 (r2 + 2 x2),  y' = y radial + p1 (r2 + 2 y2) + 2 p2 x y
//   px = fx x' + cx,  py = fy y' + cy
// D. C. Brown, "Close-range camera calibration", Photogrammetric Engineering 37(8), 1971.
struct Lens {
  static constexpr int kNumDistortion = 8;
  enum Coefficient { kK1, kK2, kP1, kP2, kK3, kK4, kK5, kK6 };

  double fx_px = 1000;
  double fy_px = 1000;
  double cx_px = 0;
  double cy_px = 0;
  std::array<double, kNumDistortion> distortion{};  // k1 k2 p1 p2 k3 k4 k5 k6

  bool operator==(const Lens&) const = default;
};

// A lens of which only the focal length is known: square pixels, the axis meets the middle.
Lens CentredLens(double focal_px, int width, int height);

// Distorts a point of the plane Z = 1. For doubles and for Ceres' Jets.
template <class T>
Eigen::Matrix<T, 2, 1> Distort(const T* k, const Eigen::Matrix<T, 2, 1>& point) {
  const T& x = point.x();
  const T& y = point.y();
  const T r2 = x * x + y * y;
  const T radial =
      (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

// Its derivative by the point.
Eigen::Matrix2d DistortJacobian(const double* k, const Eigen::Vector2d& point);

// Where a point in the camera frame appears; nothing where it is not ahead of the camera, or so far
// outside that the distortion folds the picture back over itself.
std::optional<Eigen::Vector2d> Project(const Lens& lens, const Eigen::Vector3d& point_in_cam_mm);
// The direction, z = 1, in which a pixel looks; nothing where the lens shows nothing there.
std::optional<Eigen::Vector3d> Unproject(const Lens& lens, const Eigen::Vector2d& point_px);

// Standard deviations of what a calibration estimated: 0 where it was held, NaN where not known.
struct CameraSigmas {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double fx_px = kUnknown;
  double fy_px = kUnknown;
  double cx_px = kUnknown;
  double cy_px = kUnknown;
  std::array<double, Lens::kNumDistortion> distortion = {kUnknown, kUnknown, kUnknown, kUnknown,
                                                         kUnknown, kUnknown, kUnknown, kUnknown};
  // Of cam_from_stage, small rotations about the camera's axes, and translation.
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Constant(kUnknown);
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Constant(kUnknown);
  double time_offset_s = kUnknown;
};

struct Camera {
  std::string name;
  int width = 0;  // of the picture, px
  int height = 0;
  Lens lens;
  Rigid3d cam_from_stage;
  // To be added to the times of this camera's frames to have them on the clock of the array.
  double time_offset_s = 0;
  // Where its picture shows what it sees directly; nothing: wherever no mirror's region is.
  std::optional<PictureRegion> region;
  CameraSigmas sigmas;
};

// A plane mirror that a camera sees. Points x of the stage with normal_in_stage . x = distance_mm
// are its reflecting plane; the camera is on the side where that product is smaller.
struct Mirror {
  std::string name;
  int camera = 0;                                              // index in the array
  Eigen::Vector3d normal_in_stage = Eigen::Vector3d::UnitZ();  // unit
  double distance_mm = 0;
  // A second-surface mirror: glass of this thickness lies before the plane; 0 for none.
  double glass_mm = 0;
  double glass_index = 1.52;
  // Where the camera's picture shows the mirror; nothing: wherever no other view's region is.
  std::optional<PictureRegion> region;
  // Standard deviations: of the normal's direction (the larger of its two), and of the distance.
  double normal_sigma_rad = CameraSigmas::kUnknown;
  double distance_sigma_mm = CameraSigmas::kUnknown;

  // The reflection of a point; its own inverse. Glass is not regarded.
  Eigen::Vector3d Reflect(const Eigen::Vector3d& point_in_stage_mm) const {
    return point_in_stage_mm -
           2 * (normal_in_stage.dot(point_in_stage_mm) - distance_mm) * normal_in_stage;
  }
};

// What one picture shows of the stage: a camera directly, or by one of its mirrors.
struct View {
  int camera = 0;
  int mirror = -1;  // index in the array; -1: directly

  bool operator==(const View&) const = default;
};

// A calibrated set of cameras and mirrors; the stage frame is the one that all share, mm.
struct CameraArray {
  std::vector<Camera> cameras;
  std::vector<Mirror> mirrors;
  std::string source;  // how it was made, in words

  // Every camera directly, then every mirror.
  std::vector<View> views() const;
  // Where a view stands among them.
  int IndexOf(const View& view) const;
  // "left", or "left/mirror".
  std::string NameOf(const View& view) const;
  const std::optional<PictureRegion>& RegionOf(const View& view) const;
  std::optional<PictureRegion>& RegionOf(const View& view);
  // Whether what appears there may be seen by this view. A view with a region shows nothing outside
  // of it, one without shows nothing within the regions of its camera's other views. Where regions
  // overlap, it may be either's.
  bool MayShow(const View& view, const Eigen::Vector2d& point_px) const;
};

// Where a view shows a point of the stage; nothing where it is not ahead of the camera.
std::optional<Eigen::Vector2d> Project(const CameraArray& array, const View& view,
                                       const Eigen::Vector3d& point_in_stage_mm);

// How far before the reflecting plane a second-surface mirror seems to lie, mm, for a ray that
// meets it under the angle with this cosine: glass_mm (1 - cos(i) / sqrt(n^2 - sin^2(i))). (Born &
// Wolf, Principles of Optics, plane-parallel plate.)
template <class T>
T ApparentShift(const T& cos_incidence, double glass_mm, double glass_index) {
  using std::sqrt;
  const T cos2 = cos_incidence * cos_incidence;
  return glass_mm * (1.0 - cos_incidence / sqrt(glass_index * glass_index - 1.0 + cos2));
}

}  // namespace articap
