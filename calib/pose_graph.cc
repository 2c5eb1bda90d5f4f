// SPDX-License-Identifier: MIT
#include "calib/pose_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "calib/camera_tree.h"
#include "calib/planar_pose.h"
#include "calib/robust.h"
#include "core/statistics.h"

namespace articap {
namespace {

// The sightings of one instant.
using Instants = std::map<int, std::vector<const PlacedSighting*>>;

double RmsOfView_px(const BoardSpec& board, const Camera& camera, const PlacedSighting& seen,
                    const Rigid3d& cam_from_board) {
  return RmsOfPose_px(board, camera.lens, seen.sighting->corners, seen.sighting->points_px,
                      cam_from_board);
}

// Two cameras that see the board at the same instant.
struct SharedView {
  const PlacedSighting* first = nullptr;
  const PlacedSighting* second = nullptr;
};

struct PairPose {
  Rigid3d second_from_first;
  int good_views = 0;
  double median_px = HUGE_VAL;
};

// How far the second camera's corners are from where the first one's board would appear in it: of
// its candidates the best.
double RmsOfPair_px(const BoardSpec& board, const Camera& second, const SharedView& view,
                    const Rigid3d& second_from_first) {
  double best_px = HUGE_VAL;
  for (const Rigid3d& first_from_board : view.first->cam_from_board)
    best_px = std::min(
        best_px, RmsOfView_px(board, second, *view.second, second_from_first * first_from_board));
  return best_px;
}

PairPose JudgePair(const BoardSpec& board, const Camera& second,
                   const std::vector<SharedView>& views, const Rigid3d& second_from_first) {
  PairPose pose{second_from_first, 0, HUGE_VAL};
  std::vector<double> rms_px;
  for (const SharedView& view : views) {
    rms_px.push_back(RmsOfPair_px(board, second, view, second_from_first));
    if (rms_px.back() < RoughTolerance_px(second)) ++pose.good_views;
  }
  pose.median_px = MedianOf(std::move(rms_px));
  return pose;
}

bool IsBetter(const PairPose& a, const PairPose& b) {
  return a.good_views != b.good_views ? a.good_views > b.good_views : a.median_px < b.median_px;
}

// Candidates from some of the shared views, judged by all of them.
PairPose RelatePair(const BoardSpec& board, const Camera& second,
                    const std::vector<SharedView>& views) {
  constexpr std::size_t kMostTried = 25;
  const std::size_t stride = std::max<std::size_t>(1, views.size() / kMostTried);
  PairPose best;
  for (std::size_t i = 0; i < views.size(); i += stride)
    for (const Rigid3d& first_from_board : views[i].first->cam_from_board)
      for (const Rigid3d& second_from_board : views[i].second->cam_from_board) {
        const PairPose pose =
            JudgePair(board, second, views, second_from_board * first_from_board.Inverse());
        if (IsBetter(pose, best)) best = pose;
      }
  return best;
}

struct Edge {
  int first = 0;
  int second = 0;
  PairPose pose;
};

std::vector<Edge> RelatePairs(const BoardSpec& board, const std::vector<Camera>& cameras,
                              const Instants& instants) {
  std::map<std::pair<int, int>, std::vector<SharedView>> shared;
  for (const auto& [instant, sightings] : instants)
    for (const PlacedSighting* a : sightings)
      for (const PlacedSighting* b : sightings)
        if (a->key.camera < b->key.camera) shared[{a->key.camera, b->key.camera}].push_back({a, b});
  std::vector<Edge> edges;
  for (const auto& [pair, views] : shared)
    edges.push_back({pair.first, pair.second, RelatePair(board, cameras[pair.second], views)});
  // The pairs that share most come first: Kruskal's order.
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return IsBetter(a.pose, b.pose); });
  return edges;
}

std::string NamesOf(const std::vector<Camera>& cameras, const std::vector<int>& which) {
  std::string names;
  for (int camera : which) names += (names.empty() ? "" : ", ") + cameras[camera].name;
  return names;
}

Result<void> PlaceCameras(const std::vector<Edge>& edges, std::vector<Camera>& cameras) {
  std::vector<CameraPair> pairs;
  for (const Edge& edge : edges)
    if (edge.pose.good_views > 0)
      pairs.push_back({edge.first, edge.second, edge.pose.second_from_first});
  const std::vector<bool> placed = PlaceByPairs(pairs, cameras);
  std::vector<int> linked, alone;
  for (int i = 0; i < static_cast<int>(cameras.size()); ++i)
    (placed[i] ? linked : alone).push_back(i);
  if (alone.empty()) return {};
  for (const Edge& edge : edges)
    if (placed[edge.first] != placed[edge.second])
      return Fail(fmt::format(
          "{} and {} see the board together, but where one sees it the other should see it {:.0f} "
          "px elsewhere; were their pictures taken at the same instants, and is it the same board?",
          cameras[edge.first].name, cameras[edge.second].name, edge.pose.median_px));
  return Fail(fmt::format(
      "{} never see{} the board at the same time as {}, nor by way of another camera; record the "
      "board where both see it",
      NamesOf(cameras, alone), alone.size() == 1 ? "s" : "", NamesOf(cameras, linked)));
}

// Of all candidates of all cameras the one that explains the instant's views best.
std::optional<Rigid3d> PlaceBoard(const BoardSpec& board, const std::vector<Camera>& cameras,
                                  const std::vector<const PlacedSighting*>& sightings) {
  std::optional<Rigid3d> best;
  double best_cost = HUGE_VAL;
  for (const PlacedSighting* by : sightings)
    for (const Rigid3d& cam_from_board : by->cam_from_board) {
      const Rigid3d stage_from_board =
          cameras[by->key.camera].cam_from_stage.Inverse() * cam_from_board;
      double cost = 0;
      for (const PlacedSighting* seen : sightings) {
        const Camera& camera = cameras[seen->key.camera];
        cost += std::min(
            1e3, RmsOfView_px(board, camera, *seen, camera.cam_from_stage * stage_from_board));
      }
      if (cost < best_cost) {
        best_cost = cost;
        best = stage_from_board;
      }
    }
  return best;
}

}  // namespace

Result<Network> LinkCameras(const BoardSpec& board, const std::vector<Camera>& cameras,
                            const std::vector<PlacedSighting>& sightings) {
  Instants instants;
  for (const PlacedSighting& sighting : sightings)
    instants[sighting.instant.number].push_back(&sighting);
  Network network;
  network.board = board;
  network.array.cameras = cameras;
  const auto placed = PlaceCameras(RelatePairs(board, cameras, instants), network.array.cameras);
  if (!placed) return tl::unexpected(placed.error());
  for (const auto& [instant, of_instant] : instants) {
    const auto stage_from_board = PlaceBoard(board, network.array.cameras, of_instant);
    if (!stage_from_board) continue;
    for (const PlacedSighting* seen : of_instant)
      network.sightings.push_back({{seen->key.camera, -1},
                                   static_cast<int>(network.placements.size()),
                                   SecondsOf(seen->sighting->time),
                                   seen->key.sighting,
                                   seen->sighting->corners,
                                   seen->sighting->points_px});
    network.placements.push_back({*stage_from_board, of_instant.front()->instant.time_s});
  }
  return network;
}

}  // namespace articap
