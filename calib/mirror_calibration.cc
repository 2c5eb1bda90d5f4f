// SPDX-License-Identifier: MIT
#include "calib/mirror_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "calib/lens_solver.h"
#include "calib/mirror_network.h"
#include "calib/network_calibration.h"

namespace articap {
namespace {

Result<void> RefuseUnusable(const BoardSpec& board, const CameraSightings& camera,
                            const MirrorOptions& options) {
  if (const auto thickness = RequireNotNegative({{"glass_mm", options.glass_mm}}); !thickness)
    return thickness;
  if (options.mirrors < 1 || !(options.glass_index >= 1))
    return Fail(fmt::format(
        "mirrors is {}, glass_index {:g}; there is one mirror at least, and no glass below 1",
        options.mirrors, options.glass_index));
  if (const auto told = RequireToldCorners(board); !told) return told;
  if (camera.sightings.empty())
    return Fail(fmt::format("{}: no picture shows the board", camera.camera));
  std::map<std::int64_t, std::pair<bool, bool>> ways;
  for (const BoardSighting& sighting : camera.sightings)
    (sighting.mirrored ? ways[sighting.frame].second : ways[sighting.frame].first) = true;
  const auto both = std::count_if(ways.begin(), ways.end(), [](const auto& picture) {
    return picture.second.first && picture.second.second;
  });
  constexpr int kFewest = 3;
  if (both >= kFewest) return {};
  const auto direct = std::count_if(ways.begin(), ways.end(),
                                    [](const auto& picture) { return picture.second.first; });
  return Fail(fmt::format(
      "{}: {} of {} pictures show the board both directly and in the mirror, {} directly; at least "
      "{} are needed, better 15: hold the board where the camera sees it and its reflection",
      camera.camera, both, ways.size(), direct, kFewest));
}

// From what is seen directly: glass before a mirror is nothing that a lens alone could explain.
Result<StartingLens> StartDirectly(const BoardSpec& board, const CameraSightings& camera,
                                   const LensOptions& lens_options, const MirrorOptions& options) {
  CameraSightings direct = camera;
  std::vector<int> index_in_camera;
  direct.sightings.clear();
  for (int i = 0; i < static_cast<int>(camera.sightings.size()); ++i)
    if (!camera.sightings[i].mirrored) {
      direct.sightings.push_back(camera.sightings[i]);
      index_in_camera.push_back(i);
    }
  Result<StartingLens> start = StartLens(board, direct, lens_options, !options.adjust_lens);
  if (!start) return start;
  LeftOutSightings set_aside;
  for (const auto& [key, reason] : start->set_aside)
    set_aside[{0, index_in_camera[key.sighting]}] = reason;
  start->set_aside = std::move(set_aside);
  return start;
}

}  // namespace

void VisitOptions(MirrorOptions& options, OptionVisitor& visit) {
  visit("mirrors", options.mirrors, "how many plane mirrors the camera sees");
  visit("glass_mm", options.glass_mm,
        "thickness of the glass before a second-surface mirror's silver; 0: front surface; mm");
  visit("glass_index", options.glass_index, "refractive index of that glass");
  visit(
      "adjust_lens", options.adjust_lens,
      "adjust a lens that was calibrated before along with the mirror; false: hold a lens that was "
      "calibrated before");
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

Result<StageResult<Calibration>> CalibrateMirror(const BoardSpec& board,
                                                 const CameraSightings& camera,
                                                 const LensOptions& lens_options,
                                                 const MirrorOptions& options) {
  if (const auto usable = RefuseUnusable(board, camera, options); !usable)
    return tl::unexpected(usable.error());
  Result<StartingLens> start = StartDirectly(board, camera, lens_options, options);
  if (!start) return tl::unexpected(start.error());
  LeftOutSightings set_aside = std::move(start->set_aside);
  Result<Network> network = StartMirrorNetwork(board, camera, start->camera, options, set_aside);
  if (!network) return tl::unexpected(network.error());
  AdjustOptions adjust;
  adjust.lenses = {start->freedom};
  StageResult<Calibration> mirror =
      CalibrateNetwork("calibrate mirror", {camera},
                       {*std::move(network),
                        std::move(adjust),
                        {start->model},
                        std::move(set_aside),
                        std::move(start->warnings)},
                       lens_options, {options.huber_sigmas, options.set_views_aside},
                       {.max_rms_px = options.max_rms_px,
                        .max_focal_sigma_percent = lens_options.max_focal_sigma_percent,
                        .max_rigidity_mm = options.max_rigidity_mm,
                        .max_held_focal_percent = options.max_held_focal_percent,
                        .max_misfit = options.max_misfit});
  mirror.report.options = EchoOptions(options);
  return mirror;
}

}  // namespace articap
