// SPDX-License-Identifier: MIT
#include "tracking/sight_line.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/check.h"

namespace articap {
namespace {

// W with W^T W = covariance^-1.
Eigen::Matrix2d WhiteningOf(const Eigen::Matrix2d& covariance) {
  const Eigen::LLT<Eigen::Matrix2d> factor(covariance);
  return factor.matrixL().solve(Eigen::Matrix2d::Identity());
}

struct Normal {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  double chi2 = 0;
};

std::optional<Normal> Linearize(std::span<const SightLine* const> lines,
                                const Eigen::Vector3d& point) {
  Normal normal;
  for (const SightLine* line : lines) {
    const Eigen::Vector3d in_cam = line->rotation * point + line->translation_mm;
    if (!(in_cam.z() > 0)) return std::nullopt;
    const Eigen::Vector2d plane = in_cam.hnormalized();
    Eigen::Matrix<double, 2, 3> by_cam;
    by_cam << 1, 0, -plane.x(), 0, 1, -plane.y();
    const Eigen::Matrix<double, 2, 3> jacobian =
        line->whitening * (by_cam * line->rotation) / in_cam.z();
    const Eigen::Vector2d residual = line->whitening * (line->direction - plane);
    normal.matrix.noalias() += jacobian.transpose() * jacobian;
    normal.side.noalias() += jacobian.transpose() * residual;
    normal.chi2 += residual.squaredNorm();
  }
  return normal;
}

}  // namespace

ViewProjection ProjectionOf(const CameraArray& array, const View& view) {
  const Rigid3d& cam_from_stage = array.cameras.at(view.camera).cam_from_stage;
  const Eigen::Matrix3d rotation = cam_from_stage.rotation.toRotationMatrix();
  const Eigen::Vector3d eye = cam_from_stage.Inverse().translation_mm;
  if (view.mirror < 0) return {view, rotation, cam_from_stage.translation_mm, eye};
  const Mirror& mirror = array.mirrors.at(view.mirror);
  const Eigen::Vector3d& normal = mirror.normal_in_stage;
  const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2 * normal * normal.transpose();
  return {view, rotation * reflection,
          cam_from_stage.translation_mm + 2 * mirror.distance_mm * (rotation * normal),
          mirror.Reflect(eye)};
}

std::optional<SightLine> SightLineOf(const CameraArray& array, const ViewProjection& projection,
                                     const Dot& dot, double slack_px) {
  const Lens& lens = array.cameras.at(projection.view.camera).lens;
  const std::optional<Eigen::Vector3d> in_cam = Unproject(lens, dot.center_px);
  if (!in_cam) return std::nullopt;
  SightLine line;
  line.rotation = projection.rotation;
  line.translation_mm = projection.translation_mm;
  line.direction = in_cam->head<2>();
  line.px_of_plane = Eigen::Vector2d(lens.fx_px, lens.fy_px).asDiagonal() *
                     DistortJacobian(lens.distortion.data(), line.direction);
  line.whitening =
      WhiteningOf(dot.covariance_px2 + slack_px * slack_px * Eigen::Matrix2d::Identity()) *
      line.px_of_plane;
  line.eye_in_stage_mm = projection.eye_in_stage_mm;
  // Reflections are their own inverses, and so are the transposes of improper rotations.
  line.ray_in_stage = (projection.rotation.transpose() * *in_cam).normalized();
  if (projection.view.mirror < 0) return line;
  const Mirror& mirror = array.mirrors.at(projection.view.mirror);
  if (mirror.glass_mm == 0) return line;
  // The reflected ray leaves the mirror against its normal.
  const double cos_incidence = -mirror.normal_in_stage.dot(line.ray_in_stage);
  const Eigen::Vector3d shift = 2 *
                                ApparentShift(cos_incidence, mirror.glass_mm, mirror.glass_index) *
                                mirror.normal_in_stage;
  // R (reflect(p) - shift) + t, where R is the camera's own rotation.
  line.translation_mm += projection.rotation * shift;  // R n = -(R (I - 2 n n^T)) n
  line.eye_in_stage_mm =
      mirror.Reflect(array.cameras[mirror.camera].cam_from_stage.Inverse().translation_mm + shift);
  return line;
}

std::optional<Eigen::Vector2d> SightLine::Residual(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d in_cam = rotation * point + translation_mm;
  if (!(in_cam.z() > 0)) return std::nullopt;
  return Eigen::Vector2d(whitening * (in_cam.hnormalized() - direction));
}

std::optional<Eigen::Vector2d> SightLine::Residual_px(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d in_cam = rotation * point + translation_mm;
  if (!(in_cam.z() > 0)) return std::nullopt;
  return Eigen::Vector2d(px_of_plane * (in_cam.hnormalized() - direction));
}

std::optional<RayMeeting> MeetingOf(const SightLine& first, const SightLine& second) {
  constexpr double kParallel = 1e-9;  // squared sine of the angle between them
  const double cosine = first.ray_in_stage.dot(second.ray_in_stage);
  const double sine2 = 1 - cosine * cosine;
  if (!(sine2 > kParallel)) return std::nullopt;
  const Eigen::Vector3d between = second.eye_in_stage_mm - first.eye_in_stage_mm;
  const double by_first = between.dot(first.ray_in_stage);
  const double by_second = between.dot(second.ray_in_stage);
  RayMeeting meeting;
  meeting.along_first_mm = (by_first - cosine * by_second) / sine2;
  meeting.along_second_mm = (cosine * by_first - by_second) / sine2;
  const Eigen::Vector3d on_first =
      first.eye_in_stage_mm + meeting.along_first_mm * first.ray_in_stage;
  const Eigen::Vector3d on_second =
      second.eye_in_stage_mm + meeting.along_second_mm * second.ray_in_stage;
  meeting.middle_mm = (on_first + on_second) / 2;
  meeting.apart_mm = (on_first - on_second).norm();
  return meeting;
}

std::optional<SightedPoint> PointOf(std::span<const SightLine* const> lines) {
  constexpr int kMostSteps = 10;
  constexpr double kStill_mm = 1e-6;
  if (lines.size() < 2) return std::nullopt;
  const auto start = MeetingOf(*lines[0], *lines[1]);
  if (!start) return std::nullopt;
  SightedPoint result;
  result.point_in_stage_mm = start->middle_mm;
  for (int step = 0; step < kMostSteps; ++step) {
    const auto normal = Linearize(lines, result.point_in_stage_mm);
    if (!normal) return std::nullopt;
    result.covariance_mm2 = normal->matrix.inverse();
    result.chi2 = normal->chi2;
    const Eigen::Vector3d change = result.covariance_mm2 * normal->side;
    if (!change.allFinite()) return std::nullopt;
    if (change.norm() < kStill_mm) return result;
    result.point_in_stage_mm += change;
  }
  return std::nullopt;
}

}  // namespace articap
