// SPDX-License-Identifier: MIT
#include "core/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace articap {
namespace {

// Whether the distortion is so small, at this radius and below, that the picture cannot fold: no
// term can outweigh the undistorted 1. Most lenses are like that in most of their picture, and this
// is quicker than looking closer.
bool IsFarFromFold(const Lens& lens, const Eigen::Vector2d& point) {
  const auto& k = lens.distortion;
  if (k[5] != 0 || k[6] != 0 || k[7] != 0) return false;
  const double r2 = point.squaredNorm();
  const double radial =
      r2 * (3 * std::abs(k[0]) + r2 * (5 * std::abs(k[1]) + r2 * 7 * std::abs(k[4])));
  const double tangential = 6 * std::sqrt(r2) * (std::abs(k[2]) + std::abs(k[3]));
  return radial + tangential < 0.9;
}

// Whether the picture is not yet folded back between the axis and this point of the plane Z = 1.
bool IsBeforeFold(const Lens& lens, const Eigen::Vector2d& point) {
  constexpr int kSteps = 8;
  if (IsFarFromFold(lens, point)) return true;
  for (int step = 1; step <= kSteps; ++step) {
    const Eigen::Vector2d between = point * (static_cast<double>(step) / kSteps);
    const Eigen::Matrix2d jacobian = DistortJacobian(lens.distortion.data(), between);
    if (!(jacobian.determinant() > 0) || !(jacobian.trace() > 0)) return false;
  }
  return true;
}

}  // namespace

Lens CentredLens(double focal_px, int width, int height) {
  return {focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0, {}};
}

Eigen::Matrix2d DistortJacobian(const double* k, const Eigen::Vector2d& point) {
  const double x = point.x(), y = point.y();
  const double r2 = x * x + y * y;
  const double above = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double below = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double above_r2 = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double below_r2 = k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]);
  const double radial = above / below;
  const double radial_r2 = (above_r2 - radial * below_r2) / below;
  const double mixed = 2 * (radial_r2 * x * y + k[2] * x + k[3] * y);
  Eigen::Matrix2d jacobian;
  jacobian << radial + 2 * radial_r2 * x * x + 2 * k[2] * y + 6 * k[3] * x, mixed, mixed,
      radial + 2 * radial_r2 * y * y + 6 * k[2] * y + 2 * k[3] * x;
  return jacobian;
}

std::optional<Eigen::Vector2d> Project(const Lens& lens, const Eigen::Vector3d& point_in_cam_mm) {
  if (!(point_in_cam_mm.z() > 0)) return std::nullopt;
  const Eigen::Vector2d point = point_in_cam_mm.hnormalized();
  if (!IsBeforeFold(lens, point)) return std::nullopt;
  const Eigen::Vector2d distorted = Distort(lens.distortion.data(), point);
  return Eigen::Vector2d{lens.fx_px * distorted.x() + lens.cx_px,
                         lens.fy_px * distorted.y() + lens.cy_px};
}

std::optional<Eigen::Vector3d> Unproject(const Lens& lens, const Eigen::Vector2d& point_px) {
  constexpr int kMostSteps = 30;
  constexpr double kNear = 1e-13;  // of the plane Z = 1: far below any pixel
  const Eigen::Vector2d distorted{(point_px.x() - lens.cx_px) / lens.fx_px,
                                  (point_px.y() - lens.cy_px) / lens.fy_px};
  if (!distorted.allFinite()) return std::nullopt;
  // Newton's method, from where there is no distortion; steps that leave the unfolded part are
  // halved.
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector2d error = distorted - Distort(lens.distortion.data(), point);
    if (error.norm() <= kNear * (1 + distorted.norm())) return point.homogeneous();
    Eigen::Vector2d change = DistortJacobian(lens.distortion.data(), point).inverse() * error;
    for (int halving = 0; halving < 20 && !IsBeforeFold(lens, point + change); ++halving)
      change /= 2;
    point += change;
    if (!point.allFinite()) return std::nullopt;
  }
  return std::nullopt;
}

std::vector<View> CameraArray::views() const {
  std::vector<View> views;
  for (int camera = 0; camera < static_cast<int>(cameras.size()); ++camera)
    views.push_back({camera, -1});
  for (int mirror = 0; mirror < static_cast<int>(mirrors.size()); ++mirror)
    views.push_back({mirrors[mirror].camera, mirror});
  return views;
}

int CameraArray::IndexOf(const View& view) const {
  return view.mirror < 0 ? view.camera : static_cast<int>(cameras.size()) + view.mirror;
}

std::string CameraArray::NameOf(const View& view) const {
  const std::string& camera = cameras.at(view.camera).name;
  return view.mirror < 0 ? camera : camera + "/" + mirrors.at(view.mirror).name;
}

const std::optional<PictureRegion>& CameraArray::RegionOf(const View& view) const {
  return view.mirror < 0 ? cameras.at(view.camera).region : mirrors.at(view.mirror).region;
}

std::optional<PictureRegion>& CameraArray::RegionOf(const View& view) {
  return view.mirror < 0 ? cameras.at(view.camera).region : mirrors.at(view.mirror).region;
}

bool CameraArray::MayShow(const View& view, const Eigen::Vector2d& point_px) const {
  if (const auto& region = RegionOf(view)) return region->Contains(point_px);
  const auto shows = [&](const std::optional<PictureRegion>& region) {
    return region && region->Contains(point_px);
  };
  return !shows(cameras.at(view.camera).region) &&
         std::none_of(mirrors.begin(), mirrors.end(), [&](const Mirror& mirror) {
           return mirror.camera == view.camera && shows(mirror.region);
         });
}

std::optional<Eigen::Vector2d> Project(const CameraArray& array, const View& view,
                                       const Eigen::Vector3d& point_in_stage_mm) {
  const Camera& camera = array.cameras.at(view.camera);
  if (view.mirror < 0) return Project(camera.lens, camera.cam_from_stage * point_in_stage_mm);
  const Mirror& mirror = array.mirrors.at(view.mirror);
  ARTICAP_CHECK_EQ(mirror.camera, view.camera);
  // What stands behind the mirror, it does not show.
  const Eigen::Vector3d& normal = mirror.normal_in_stage;
  if (!(normal.dot(point_in_stage_mm) < mirror.distance_mm)) return std::nullopt;
  const Eigen::Vector3d reflected = mirror.Reflect(point_in_stage_mm);
  if (mirror.glass_mm == 0) return Project(camera.lens, camera.cam_from_stage * reflected);
  // The shift depends on the angle and the angle, weakly, on the shift.
  const Eigen::Vector3d eye = camera.cam_from_stage.Inverse().translation_mm;
  Eigen::Vector3d seen = reflected;
  for (int round = 0; round < 5; ++round) {
    const double cos_incidence = normal.dot((seen - eye).normalized());
    seen =
        reflected - 2 * ApparentShift(cos_incidence, mirror.glass_mm, mirror.glass_index) * normal;
  }
  return Project(camera.lens, camera.cam_from_stage * seen);
}

}  // namespace articap
