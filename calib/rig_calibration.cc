// SPDX-License-Identifier: MIT
#include "calib/rig_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/instants.h"
#include "calib/lens_solver.h"
#include "calib/network_calibration.h"
#include "calib/planar_pose.h"
#include "calib/pose_graph.h"

namespace articap {
namespace {

// The cameras one by one, before anything is known of where they stand.
struct StartingCameras {
  std::vector<Camera> cameras;
  std::vector<LensModel> models;
  std::vector<LensFreedom> freedoms;
  LeftOutSightings set_aside;
  std::vector<std::string> warnings;
};

Result<void> RefuseUnusable(const BoardSpec& board, const std::vector<CameraSightings>& cameras) {
  if (cameras.size() < 2)
    return Fail("a rig has two cameras or more; for one, use 'articap calibrate lens'");
  if (const auto told = RequireToldCorners(board); !told) return told;
  std::string empty;
  for (const CameraSightings& camera : cameras)
    if (camera.sightings.empty()) empty += (empty.empty() ? "" : ", ") + camera.camera;
  if (!empty.empty())
    return Fail(
        fmt::format("{}: no picture shows the board so that it can be used; record again, or leave "
                    "the camera out",
                    empty));
  return {};
}

Result<StartingCameras> SolveLenses(const BoardSpec& board,
                                    const std::vector<CameraSightings>& inputs,
                                    const LensOptions& lens_options, const RigOptions& options) {
  StartingCameras start;
  for (int index = 0; index < static_cast<int>(inputs.size()); ++index) {
    Result<StartingLens> lens =
        StartLens(board, inputs[index], lens_options, !options.adjust_lenses);
    if (!lens) return tl::unexpected(lens.error());
    start.cameras.push_back(std::move(lens->camera));
    start.models.push_back(lens->model);
    start.freedoms.push_back(lens->freedom);
    for (auto& [key, reason] : lens->set_aside) start.set_aside[{index, key.sighting}] = reason;
    for (const std::string& warning : lens->warnings)
      start.warnings.push_back(inputs[index].camera + ": " + warning);
  }
  return start;
}

// Every sighting that is kept, with the poses that its lens allows.
std::vector<PlacedSighting> PlaceSightings(const BoardSpec& board,
                                           const std::vector<CameraSightings>& inputs,
                                           const InstantTable& instants,
                                           const StartingCameras& start) {
  std::vector<PlacedSighting> placed;
  for (int camera = 0; camera < static_cast<int>(inputs.size()); ++camera)
    for (int index = 0; index < static_cast<int>(inputs[camera].sightings.size()); ++index) {
      const SightingKey key{camera, index};
      const auto instant = instants.find(key);
      if (start.set_aside.contains(key) || instant == instants.end()) continue;
      const BoardSighting& sighting = inputs[camera].sightings[index];
      std::vector<Rigid3d> poses;
      for (const PlanarPose& pose :
           PlanarPosesOf(board, start.cameras[camera].lens, sighting.corners, sighting.points_px))
        poses.push_back(pose.cam_from_board);
      if (!poses.empty()) placed.push_back({key, instant->second, poses, &sighting});
    }
  return placed;
}

}  // namespace

void VisitOptions(RigOptions& options, OptionVisitor& visit) {
  visit("adjust_lenses", options.adjust_lenses,
        "adjust lenses that were calibrated before along with the rest; false: hold lenses that "
        "were calibrated before");
  visit("free_time_offsets", options.free_time_offsets,
        "the cameras are not synchronous: estimate each one's offset from the moving board");
  visit("huber_sigmas", options.huber_sigmas,
        "corners off by more standard deviations count less; 0: plain least squares");
  visit("set_views_aside", options.set_views_aside,
        "leave out views that do not fit the others; false: keep views that do not fit the others");
  visit("max_rms_px", options.max_rms_px, "not usable with larger residuals; px");
  visit("max_rigidity_mm", options.max_rigidity_mm,
        "not usable with larger errors of distances on held-out views; mm");
  visit("max_held_focal_percent", options.max_held_focal_percent,
        "not usable where the pictures contradict the focal length of a lens that is held by more; "
        "percent");
  visit("max_misfit", options.max_misfit,
        "not usable where residuals are more times as large as neighbouring corners tell");
}

Result<StageResult<Calibration>> CalibrateRig(const BoardSpec& board,
                                              const std::vector<CameraSightings>& cameras,
                                              const LensOptions& lens_options,
                                              const RigOptions& options) {
  if (const auto usable = RefuseUnusable(board, cameras); !usable)
    return tl::unexpected(usable.error());
  Result<StartingCameras> start = SolveLenses(board, cameras, lens_options, options);
  if (!start) return tl::unexpected(start.error());
  const InstantTable instants =
      options.free_time_offsets ? InstantsByTime(cameras) : InstantsByFrame(cameras);
  Result<Network> network =
      LinkCameras(board, start->cameras, PlaceSightings(board, cameras, instants, *start));
  if (!network) return tl::unexpected(network.error());
  network->moving = options.free_time_offsets;
  SetAsideUnplaced(cameras, *network, start->set_aside);
  AdjustOptions adjust;
  adjust.lenses = std::move(start->freedoms);
  adjust.free_time_offsets = options.free_time_offsets;
  StageResult<Calibration> rig =
      CalibrateNetwork("calibrate rig", cameras,
                       {*std::move(network), std::move(adjust), std::move(start->models),
                        std::move(start->set_aside), std::move(start->warnings)},
                       lens_options, {options.huber_sigmas, options.set_views_aside},
                       {.max_rms_px = options.max_rms_px,
                        .max_focal_sigma_percent = lens_options.max_focal_sigma_percent,
                        .max_rigidity_mm = options.max_rigidity_mm,
                        .max_held_focal_percent = options.max_held_focal_percent,
                        .max_misfit = options.max_misfit});
  rig.report.options = EchoOptions(options);
  return rig;
}

}  // namespace articap
