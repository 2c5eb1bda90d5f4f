// SPDX-License-Identifier: MIT
#include "calib/network_screening.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

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

}  // namespace

double HuberFor_px(const std::vector<std::vector<Eigen::Vector2d>>& residuals_px, double sigmas) {
  // Perfect corners, as tests make them, have no residuals to take a scale from.
  constexpr double kLeast_px = 1e-3;
  return sigmas == 0 ? 0 : std::max(kLeast_px, sigmas * RobustSigmaOf(residuals_px));
}

AdjustedNetwork AdjustAndScreen(Network network, AdjustOptions adjust, const ScreenOptions& options,
                                LeftOutSightings& set_aside) {
  constexpr int kMostRounds = 3;
  SetAsideBehind(network, set_aside);
  adjust.huber_px = options.huber_sigmas == 0 ? 0 : 1;
  AdjustedNetwork adjusted = AdjustMoving(std::move(network), adjust);
  for (int round = 0;; ++round) {
    adjust.huber_px = HuberFor_px(adjusted.residuals_px, options.huber_sigmas);
    adjusted = AdjustMoving(adjusted.network, adjust);
    if (!options.set_views_aside || round == kMostRounds) return adjusted;
    std::vector<BadSighting> bad = ScreenSightings(adjusted);
    if (bad.empty()) return adjusted;
    std::reverse(bad.begin(), bad.end());  // the last first: indices stay right
    for (const BadSighting& sighting : bad) {
      auto& all = adjusted.network.sightings;
      const NetworkSighting& removed = all[sighting.sighting];
      set_aside[{removed.view.camera, removed.input}] = sighting.reason;
      all.erase(all.begin() + sighting.sighting);
    }
  }
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
