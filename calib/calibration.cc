// SPDX-License-Identifier: MIT
#include "calib/calibration.h"

#include <fmt/format.h>

#include <algorithm>

#include "calib/planar_pose.h"
#include "calib/view_noise.h"

namespace articap {
namespace {

// As the lens sees it that was made without it: the board's pose alone is fitted.
std::vector<Eigen::Vector2d> ResidualsAlone(const BoardSpec& board, const Camera& camera,
                                            const BoardSighting& sighting) {
  const std::vector<PlanarPose> poses =
      PlanarPosesOf(board, camera.lens, sighting.corners, sighting.points_px);
  if (poses.empty()) return {};
  Network network;
  network.board = board;
  network.array.cameras = {camera};
  network.array.cameras[0].cam_from_stage = {};
  network.placements = {{poses.front().cam_from_board, 0}};
  network.sightings = {{{0, -1}, 0, 0, 0, sighting.corners, sighting.points_px}};
  AdjustOptions options;
  options.huber_px = 0.5;  // so that displaced corners show, and do not drag the others
  return Adjust(network, options).residuals_px[0];
}

// What no sighting shows was not estimated, and stands where it started: nothing is known of it.
void ForgetUnseen(const Network& network, CameraArray& array) {
  std::vector<bool> camera_seen(array.cameras.size(), false);
  std::vector<bool> mirror_seen(array.mirrors.size(), false);
  for (const NetworkSighting& sighting : network.sightings) {
    camera_seen[sighting.view.camera] = true;
    if (sighting.view.mirror >= 0) mirror_seen[sighting.view.mirror] = true;
  }
  for (std::size_t i = 0; i < camera_seen.size(); ++i)
    if (!camera_seen[i]) array.cameras[i].sigmas = {};
  for (std::size_t i = 0; i < mirror_seen.size(); ++i)
    if (!mirror_seen[i])
      array.mirrors[i].normal_sigma_rad = array.mirrors[i].distance_sigma_mm =
          CameraSigmas::kUnknown;
}

}  // namespace

Camera CameraWith(const CameraSightings& sightings, const Lens& lens) {
  return {
      .name = sightings.camera, .width = sightings.width, .height = sightings.height, .lens = lens};
}

double Calibration::rms_px() const {
  DistanceRms rms;
  for (const SightingResult& sighting : sightings)
    if (sighting.used) rms.Add(sighting.residuals_px);
  return rms.px();
}

Result<void> RequireToldCorners(const BoardSpec& board) {
  if (!board.is_ambiguous()) return {};
  return Fail(fmt::format(
      "{} looks the same upside down, so that two views of it cannot agree which corner is which; "
      "use a board with an even number of corners one way and an odd one the other, or a ChArUco "
      "board",
      NameOf(board)));
}

Calibration MakeCalibration(const std::vector<CameraSightings>& inputs,
                            const AdjustedNetwork& adjusted, const LeftOutSightings& set_aside) {
  const Network& network = adjusted.network;
  Calibration calibration;
  calibration.array = network.array;
  ForgetUnseen(network, calibration.array);
  calibration.board = network.board;
  calibration.placements = network.placements;
  calibration.sigma_px = adjusted.sigma_px;
  calibration.noise_px = adjusted.noise_px;
  calibration.local_noise_px = LocalNoiseOfViews_px(adjusted);
  calibration.degrees_of_freedom = adjusted.degrees_of_freedom;
  calibration.parameters = adjusted.parameters;
  calibration.covariance = adjusted.covariance;
  for (std::size_t i = 0; i < network.sightings.size(); ++i) {
    const NetworkSighting& sighting = network.sightings[i];
    calibration.sightings.push_back(
        {.source = inputs[sighting.view.camera].sightings[sighting.input].source,
         .view = sighting.view,
         .placement = sighting.placement,
         .corners = sighting.corners,
         .points_px = sighting.points_px,
         .residuals_px = adjusted.residuals_px[i]});
  }
  for (const auto& [key, reason] : set_aside) {
    const BoardSighting& sighting = inputs[key.camera].sightings[key.sighting];
    calibration.sightings.push_back(
        {.source = sighting.source,
         // Which mirror it was nobody knows any more.
         .view = {key.camera, sighting.mirrored && !network.array.mirrors.empty() ? 0 : -1},
         .used = false,
         .reason = reason,
         .corners = sighting.corners,
         .points_px = sighting.points_px,
         .residuals_px =
             ResidualsAlone(network.board, network.array.cameras[key.camera], sighting)});
  }
  std::stable_sort(calibration.sightings.begin(), calibration.sightings.end(),
                   [](const SightingResult& a, const SightingResult& b) {
                     return a.view.camera < b.view.camera;
                   });
  return calibration;
}

}  // namespace articap
