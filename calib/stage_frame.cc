// SPDX-License-Identifier: MIT
#include "calib/stage_frame.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/triangulation.h"

namespace articap {
namespace {

// Where the parameters of a camera's pose (rotation, then translation) or of a mirror begin in the
// covariance.
std::optional<int> ColumnOf(const std::vector<CameraParameter>& parameters,
                            const CameraParameter& first) {
  const auto found = std::find(parameters.begin(), parameters.end(), first);
  if (found == parameters.end()) return std::nullopt;
  return static_cast<int>(found - parameters.begin());
}

// t' = t + R s, with s the new origin in the old frame; R' = exp(w) R moves it by w x (R s).
Eigen::Vector3d TranslationSigmas(const Eigen::Matrix<double, 6, 6>& covariance,
                                  const Eigen::Vector3d& new_origin_in_cam_axes) {
  const Eigen::Vector3d& a = new_origin_in_cam_axes;
  Eigen::Matrix<double, 3, 6> by_pose;
  by_pose << 0, a.z(), -a.y(), 1, 0, 0,  //
      -a.z(), 0, a.x(), 0, 1, 0,         //
      a.y(), -a.x(), 0, 0, 0, 1;
  return (by_pose * covariance * by_pose.transpose()).diagonal().cwiseSqrt();
}

// The distance of a plane from the new origin p, both in the camera frame, is |f| - n . p for its
// foot f = |f| n: by the foot, n - (p - n (n . p)) / |f|. The camera that looks into it is held.
double DistanceSigma(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& foot,
                     const Eigen::Vector3d& new_origin_in_cam) {
  const Eigen::Vector3d normal = foot.normalized();
  const Eigen::Vector3d across = new_origin_in_cam - normal * normal.dot(new_origin_in_cam);
  const Eigen::Vector3d by_foot = normal - across / foot.norm();
  return std::sqrt(by_foot.dot(covariance * by_foot));
}

using Points3 = std::array<Eigen::Vector3d, 3>;

struct Solid {
  Points3 points = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double rms_px = HUGE_VAL;
};

std::optional<Solid> TriangulateAll(const CameraArray& array,
                                    const std::array<std::vector<Sight>, 3>& sights) {
  Solid solid;
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    const auto point = Triangulate(array, sights[i]);
    if (!point) return std::nullopt;
    solid.points[i] = point->point_in_stage_mm;
    squares += point->rms_px * point->rms_px;
  }
  solid.rms_px = std::sqrt(squares / 3);
  return solid;
}

// The markers as the first camera counts them: of each further camera's orders the one in which the
// rays meet best.
Result<Solid> MatchMarkers(const CameraArray& array,
                           const std::vector<std::vector<Eigen::Vector2d>>& points_px) {
  std::array<std::vector<Sight>, 3> sights;
  Solid best;
  for (int camera = 0; camera < static_cast<int>(points_px.size()); ++camera) {
    const auto& seen = points_px[camera];
    if (seen.size() != 3) continue;
    std::array<int, 3> order = {0, 1, 2}, best_order = order;
    best = {};
    do {
      auto with = sights;
      for (int i = 0; i < 3; ++i) with[i].push_back({{camera, -1}, seen[order[i]]});
      if (with[0].size() < 2) break;  // the first camera's own order
      const auto solid = TriangulateAll(array, with);
      if (solid && solid->rms_px < best.rms_px) {
        best = *solid;
        best_order = order;
      }
    } while (std::next_permutation(order.begin(), order.end()));
    for (int i = 0; i < 3; ++i) sights[i].push_back({{camera, -1}, seen[best_order[i]]});
  }
  if (sights[0].size() < 2)
    return Fail(fmt::format(
        "the L-frame's three markers are seen by {} camera; two at least must show all three and "
        "nothing else that is bright",
        sights[0].size()));
  if (!std::isfinite(best.rms_px))
    return Fail("the cameras' views of the L-frame do not meet anywhere");
  return best;
}

}  // namespace

void MoveStage(const std::vector<CameraParameter>& parameters, const Eigen::MatrixXd& covariance,
               const Rigid3d& new_from_old, CameraArray& array) {
  const Rigid3d old_from_new = new_from_old.Inverse();
  for (int i = 0; i < static_cast<int>(array.mirrors.size()); ++i) {
    Mirror& mirror = array.mirrors[i];
    const Rigid3d& cam_from_old = array.cameras[mirror.camera].cam_from_stage;
    if (const auto column = ColumnOf(parameters, {CameraParameter::Kind::kMirror, i, 0})) {
      const Eigen::Vector3d normal = cam_from_old.rotation * mirror.normal_in_stage;
      const Eigen::Vector3d foot =
          normal * (mirror.distance_mm + normal.dot(cam_from_old.translation_mm));
      mirror.distance_sigma_mm = DistanceSigma(covariance.block<3, 3>(*column, *column), foot,
                                               cam_from_old * old_from_new.translation_mm);
    }
    // n . x = d for x = old_from_new * x'.
    mirror.distance_mm -= mirror.normal_in_stage.dot(old_from_new.translation_mm);
    mirror.normal_in_stage = new_from_old.rotation * mirror.normal_in_stage;
  }
  for (int i = 0; i < static_cast<int>(array.cameras.size()); ++i) {
    Camera& camera = array.cameras[i];
    if (const auto column = ColumnOf(parameters, {CameraParameter::Kind::kRotation, i, 0}))
      camera.sigmas.translation_mm =
          TranslationSigmas(covariance.block<6, 6>(*column, *column),
                            camera.cam_from_stage.rotation * old_from_new.translation_mm);
    camera.cam_from_stage = camera.cam_from_stage * old_from_new;
  }
}

void MoveStage(const Rigid3d& new_from_old, Calibration& calibration) {
  MoveStage(calibration.parameters, calibration.covariance, new_from_old, calibration.array);
  for (Placement& placement : calibration.placements)
    placement.stage_from_board = new_from_old * placement.stage_from_board;
}

Result<Rigid3d> StageOfCamera(const CameraArray& array, const std::string& name) {
  std::vector<std::string> names;
  for (const Camera& camera : array.cameras) {
    if (camera.name == name) return camera.cam_from_stage;
    names.push_back(camera.name);
  }
  return Fail(fmt::format("there is no camera {}; there are {}", name, fmt::join(names, ", ")));
}

Result<Rigid3d> StageOfBoard(const Calibration& calibration, const std::string& source) {
  for (const SightingResult& sighting : calibration.sightings) {
    if (sighting.source != source || !sighting.used) continue;
    const Rigid3d& old_from_board = calibration.placements[sighting.placement].stage_from_board;
    const Rigid3d board_from_new{
        Eigen::Quaterniond(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX())), {0, 0, 0}};
    return (old_from_board * board_from_new).Inverse();
  }
  return Fail(fmt::format(
      "in {} no board was used, so that it cannot be the stage; name a picture of the report's",
      source));
}

Result<LFrameStage> StageOfLFrame(const CameraArray& array,
                                  const std::vector<std::vector<Eigen::Vector2d>>& points_px,
                                  const LFrame& frame) {
  const Result<Solid> solid = MatchMarkers(array, points_px);
  if (!solid) return tl::unexpected(solid.error());
  // Of all ways to name the markers the one whose arms have the right lengths.
  std::array<int, 3> order = {0, 1, 2}, best = order;
  double best_error = HUGE_VAL;
  const auto arm = [&](const std::array<int, 3>& names, int end) -> Eigen::Vector3d {
    return solid->points[names[end]] - solid->points[names[0]];
  };
  const auto error_of = [&](const std::array<int, 3>& names) {
    return std::max(std::abs(arm(names, 1).norm() / frame.long_mm - 1),
                    std::abs(arm(names, 2).norm() / frame.short_mm - 1)) +
           std::abs(arm(names, 1).normalized().dot(arm(names, 2).normalized()));
  };
  do {
    if (error_of(order) < best_error) {
      best_error = error_of(order);
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));

  constexpr double kLargestError = 0.05;
  const Eigen::Vector3d x = arm(best, 1), along_y = arm(best, 2);
  LFrameStage stage;
  stage.long_found_mm = x.norm();
  stage.short_found_mm = along_y.norm();
  stage.angle_found_rad = std::acos(x.normalized().dot(along_y.normalized()));
  stage.rms_px = solid->rms_px;
  if (!(best_error < kLargestError))
    return Fail(fmt::format(
        "the three markers make no L-frame: arms of {:.1f} and {:.1f} mm where {:g} and {:g} were "
        "expected, {:.1f} degrees between them; are its lengths right, is the scale?",
        stage.long_found_mm, stage.short_found_mm, frame.long_mm, frame.short_mm,
        stage.angle_found_rad * 180 / M_PI));
  Eigen::Matrix3d old_from_new;
  old_from_new.col(0) = x.normalized();
  old_from_new.col(2) = x.cross(along_y).normalized();
  old_from_new.col(1) = old_from_new.col(2).cross(old_from_new.col(0));
  stage.new_from_old = Rigid3d{Eigen::Quaterniond(old_from_new), solid->points[best[0]]}.Inverse();
  return stage;
}

}  // namespace articap
