// SPDX-License-Identifier: MIT
#include "calib/network_screening.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "calib/robust.h"
#include "calib/view_noise.h"
#include "calib/view_screening.h"

namespace articap {
namespace {

// The motion that a moving network assumes comes from the placements that an adjustment starts
// from: a few rounds, until the offsets stand still.
AdjustedNetwork AdjustMoving(Network network, const AdjustOptions& options) {
  constexpr int kMostRounds = 6;
  constexpr double kStill_s = 1e-6;
  for (int round = 0;; ++round) {
    AdjustedNetwork adjusted = Adjust(network, options);
    double change_s = 0;
    for (std::size_t i = 0; i < network.array.cameras.size(); ++i)
      change_s = std::max(change_s, std::abs(adjusted.network.array.cameras[i].time_offset_s -
                                             network.array.cameras[i].time_offset_s));
    if (!options.free_time_offsets || change_s < kStill_s || round == kMostRounds) return adjusted;
    network = adjusted.network;
  }
}

// Sightings that some view has to show what is behind it: an adjustment cannot even begin there.
void SetAsideBehind(Network& network, LeftOutSightings& set_aside) {
  const auto residuals_px = ResidualsOf(network);
  std::vector<NetworkSighting> kept;
  for (std::size_t i = 0; i < network.sightings.size(); ++i) {
    NetworkSighting& sighting = network.sightings[i];
    if (std::isfinite(RmsOf(residuals_px[i])))
      kept.push_back(std::move(sighting));
    else
      set_aside[{sighting.view.camera, sighting.input}] =
          "by what other views show at this instant the board is behind this camera; are they of "
          "the same instant?";
  }
  network.sightings = std::move(kept);
}

// Weights and Huber's loss by what an adjustment left. Whether the weights change.
bool Reweigh(const AdjustedNetwork& adjusted, double huber_sigmas, AdjustOptions& adjust) {
  const bool changed = WeighViews(adjusted.noise_px, adjusted.sigma_px, adjust);
  adjust.huber_px = HuberFor_px(adjusted, adjust.relative_noise, huber_sigmas);
  return changed;
}

}  // namespace

double HuberFor_px(const AdjustedNetwork& adjusted, const std::vector<double>& relative_noise,
                   double sigmas) {
  // Perfect corners, as tests make them, have no residuals to take a scale from.
  constexpr double kLeast_px = 1e-3;
  if (sigmas == 0) return 0;
  std::vector<double> distances_px;
  for (std::size_t i = 0; i < adjusted.residuals_px.size(); ++i) {
    const int view = adjusted.network.array.IndexOf(adjusted.network.sightings[i].view);
    const double noise = relative_noise.empty() ? 1 : relative_noise[view];
    for (const Eigen::Vector2d& residual : adjusted.residuals_px[i])
      distances_px.push_back(residual.norm() / noise);
  }
  return std::max(kLeast_px, sigmas * RobustSigmaOf(std::move(distances_px)));
}

AdjustedNetwork AdjustAndScreen(Network network, AdjustOptions& adjust,
                                const ScreenOptions& options, LeftOutSightings& set_aside) {
  constexpr int kMostRounds = 3;
  constexpr int kMostWeighings = 5;  // two or three do
  SetAsideBehind(network, set_aside);
  adjust.huber_px = options.huber_sigmas == 0 ? 0 : 1;
  AdjustedNetwork adjusted = AdjustMoving(std::move(network), adjust);
  for (int round = 0;; ++round) {
    Reweigh(adjusted, options.huber_sigmas, adjust);
    adjusted = AdjustMoving(adjusted.network, adjust);
    if (!options.set_views_aside || round == kMostRounds) break;
    std::vector<BadSighting> bad = ScreenSightings(adjusted);
    if (bad.empty()) break;
    std::reverse(bad.begin(), bad.end());  // the last first: indices stay right
    for (const BadSighting& sighting : bad) {
      auto& all = adjusted.network.sightings;
      const NetworkSighting& removed = all[sighting.sighting];
      set_aside[{removed.view.camera, removed.input}] = sighting.reason;
      all.erase(all.begin() + sighting.sighting);
    }
  }
  for (int i = 0; i < kMostWeighings && Reweigh(adjusted, options.huber_sigmas, adjust); ++i)
    adjusted = AdjustMoving(adjusted.network, adjust);
  return adjusted;
}

void SetAsideUnplaced(std::span<const CameraSightings> cameras, const Network& network,
                      LeftOutSightings& set_aside) {
  std::set<SightingKey> placed;
  for (const NetworkSighting& sighting : network.sightings)
    placed.insert({sighting.view.camera, sighting.input});
  for (int camera = 0; camera < static_cast<int>(cameras.size()); ++camera)
    for (int i = 0; i < static_cast<int>(cameras[camera].sightings.size()); ++i)
      if (!placed.contains({camera, i}))
        set_aside.try_emplace({camera, i},
                              "no pose of the board explains its corners; are they too few, or on "
                              "one line, or found wrong?");
}

}  // namespace articap
