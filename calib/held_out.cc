// SPDX-License-Identifier: MIT
#include "calib/held_out.h"

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "core/triangulation.h"

namespace articap {
namespace {

// The network with only the sightings whose placement the choice is for.
template <class Choice>
Network WithPlacements(const Network& network, const Choice& is_chosen) {
  Network part = network;
  part.sightings.clear();
  for (const NetworkSighting& sighting : network.sightings)
    if (is_chosen(sighting.placement)) part.sightings.push_back(sighting);
  return part;
}

struct CornerPoint {
  int corner = 0;
  TriangulatedPoint point;
};

// Of each placement, the corners that two views or more show.
std::map<int, std::vector<CornerPoint>> TriangulateCorners(const Network& network,
                                                           const std::vector<double>& noise_px) {
  std::map<std::pair<int, int>, std::vector<Sight>> sights;  // placement, corner
  for (const NetworkSighting& sighting : network.sightings)
    for (std::size_t i = 0; i < sighting.corners.size(); ++i)
      sights[{sighting.placement, sighting.corners[i]}].push_back(
          {sighting.view, sighting.points_px[i], noise_px[network.array.IndexOf(sighting.view)]});
  std::map<int, std::vector<CornerPoint>> corners;
  for (const auto& [key, of_corner] : sights)
    if (const auto point = Triangulate(network.array, of_corner))
      corners[key.first].push_back({key.second, *point});
  return corners;
}

struct RigiditySums {
  double squares_mm2 = 0;
  double expected_mm2 = 0;
  int distances = 0;
};

void AddDistances(const BoardSpec& board, const std::vector<CornerPoint>& corners,
                  RigiditySums& sums) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Vector3d between =
          corners[i].point.point_in_stage_mm - corners[j].point.point_in_stage_mm;
      const double true_mm = (board.corner_in_board_mm(corners[i].corner) -
                              board.corner_in_board_mm(corners[j].corner))
                                 .norm();
      const Eigen::Vector3d along = between.normalized();
      const Eigen::Matrix3d covariance =
          corners[i].point.covariance_mm2 + corners[j].point.covariance_mm2;
      sums.squares_mm2 += (between.norm() - true_mm) * (between.norm() - true_mm);
      sums.expected_mm2 += along.dot(covariance * along);
      ++sums.distances;
    }
}

}  // namespace

double HeldOutRms_px(const Network& network, const LensFreedom& freedom) {
  constexpr int kFolds = 3;
  if (network.placements.size() < 2 * kFolds) return HeldOut::kUnknown;
  DistanceRms rms;
  for (int fold = 0; fold < kFolds; ++fold) {
    AdjustOptions lens_alone;
    lens_alone.lenses = {freedom};
    const AdjustedNetwork others =
        Adjust(WithPlacements(network, [&](int i) { return i % kFolds != fold; }), lens_alone);
    Network left_out = WithPlacements(network, [&](int i) { return i % kFolds == fold; });
    left_out.array = others.network.array;
    const AdjustedNetwork seen = Adjust(left_out, {});
    for (const auto& of_sighting : seen.residuals_px) rms.Add(of_sighting);
  }
  return rms.px();
}

HeldOut HeldOutRigidity(const AdjustedNetwork& adjusted, const AdjustOptions& options, int stride) {
  const Network& network = adjusted.network;
  HeldOut held_out;
  const auto is_left_out = [&](int placement) { return placement % stride == stride / 2; };
  const AdjustedNetwork others = Adjust(
      WithPlacements(network, [&](int placement) { return !is_left_out(placement); }), options);
  Network left_out = WithPlacements(network, is_left_out);
  left_out.array = others.network.array;
  RigiditySums sums;
  for (const auto& [placement, corners] : TriangulateCorners(left_out, adjusted.noise_px)) {
    AddDistances(network.board, corners, sums);
    ++held_out.views;
  }
  if (sums.distances == 0) return held_out;
  held_out.distances = sums.distances;
  held_out.rigidity_mm = std::sqrt(sums.squares_mm2 / sums.distances);
  held_out.expected_rigidity_mm = std::sqrt(sums.expected_mm2 / sums.distances);
  return held_out;
}

}  // namespace articap
