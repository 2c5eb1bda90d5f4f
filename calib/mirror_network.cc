// SPDX-License-Identifier: MIT
#include "calib/mirror_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "calib/network_screening.h"
#include "calib/planar_pose.h"
#include "calib/robust.h"

namespace articap {
namespace {

// A picture with the poses that explain its board. Of a mirrored board the pose is that of the
// image behind the mirror: a plane's reflection is a plane moved, seen from its back.
struct Picture {
  std::vector<int> direct;    // indices of sightings: one at most
  std::vector<int> mirrored;  // one a mirror at most
};

using Pictures = std::map<std::int64_t, Picture>;

struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // camera frame, away from the camera
  double distance_mm = 0;
};

struct MirrorScene {
  BoardSpec board;
  const CameraSightings* input = nullptr;
  Camera camera;
  Pictures pictures;
  std::map<int, std::vector<PlanarPose>> poses;  // of each sighting that is used
};

MirrorScene MakeScene(const BoardSpec& board, const CameraSightings& input, const Camera& camera,
                      const LeftOutSightings& set_aside) {
  MirrorScene scene{board, &input, camera, {}, {}};
  for (int i = 0; i < static_cast<int>(input.sightings.size()); ++i) {
    const BoardSighting& sighting = input.sightings[i];
    if (set_aside.contains({0, i})) continue;
    auto poses = PlanarPosesOf(board, camera.lens, sighting.corners, sighting.points_px);
    if (poses.empty()) continue;
    scene.poses[i] = std::move(poses);
    Picture& picture = scene.pictures[sighting.frame];
    (sighting.mirrored ? picture.mirrored : picture.direct).push_back(i);
  }
  return scene;
}

// The plane that reflects the board from one pose to the other: it bisects every corner's way.
std::optional<Plane> PlaneBetween(const BoardSpec& board, const Rigid3d& direct,
                                  const Rigid3d& image) {
  Eigen::Vector3d ways = Eigen::Vector3d::Zero(), middles = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < board.num_corners(); ++corner) {
    const Eigen::Vector3d in_board = board.corner_in_board_mm(corner);
    ways += image * in_board - direct * in_board;
    middles += (image * in_board + direct * in_board) / 2;
  }
  if (!(ways.norm() > 0)) return std::nullopt;
  Plane plane;
  plane.normal = ways.normalized();
  plane.distance_mm = plane.normal.dot(middles) / board.num_corners();
  // A mirror that the camera looks into is on its far side from the board's point of view too.
  if (!(plane.distance_mm > 0)) return std::nullopt;
  return plane;
}

// Where the mirror puts a board: the reflection, as a rigid pose of the plane z = 0.
Rigid3d Reflected(const Plane& plane, const Rigid3d& cam_from_board) {
  const Eigen::Vector3d& n = plane.normal;
  const Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity() - 2 * n * n.transpose();
  Eigen::Matrix3d rotation = mirror * cam_from_board.rotation.toRotationMatrix();
  rotation.col(2) *= -1;
  return {Eigen::Quaterniond(rotation),
          mirror * cam_from_board.translation_mm + 2 * plane.distance_mm * n};
}

// How far a picture's mirrored corners are from where the plane shows the board, px: the better of
// the direct poses.
double RmsOfPlane_px(const MirrorScene& scene, const Plane& plane, int direct, int mirrored) {
  const BoardSighting& seen = scene.input->sightings[mirrored];
  double best_px = HUGE_VAL;
  for (const PlanarPose& pose : scene.poses.at(direct))
    best_px =
        std::min(best_px, RmsOfPose_px(scene.board, scene.camera.lens, seen.corners, seen.points_px,
                                       Reflected(plane, pose.cam_from_board)));
  return best_px;
}

// Direct and mirrored sightings of one picture that no mirror explains yet.
struct MirrorPair {
  int direct = 0;
  int mirrored = 0;
};

// The plane that explains the most pairs.
std::optional<Plane> FindPlane(const MirrorScene& scene, const std::vector<MirrorPair>& pairs) {
  constexpr std::size_t kMostTried = 30;
  const std::size_t stride = std::max<std::size_t>(1, pairs.size() / kMostTried);
  std::optional<Plane> best;
  double best_cost = HUGE_VAL;
  const double rough_px = RoughTolerance_px(scene.camera);
  for (std::size_t i = 0; i < pairs.size(); i += stride)
    for (const PlanarPose& direct : scene.poses.at(pairs[i].direct))
      for (const PlanarPose& image : scene.poses.at(pairs[i].mirrored)) {
        const auto plane = PlaneBetween(scene.board, direct.cam_from_board, image.cam_from_board);
        if (!plane) continue;
        double cost = 0;
        for (const MirrorPair& pair : pairs)
          cost += std::min(rough_px, RmsOfPlane_px(scene, *plane, pair.direct, pair.mirrored));
        if (cost < best_cost) {
          best_cost = cost;
          best = plane;
        }
      }
  return best;
}

// Which mirror, by the planes, shows each mirrored sighting.
struct FoundMirrors {
  std::vector<Plane> planes;
  std::map<int, int> mirror_of;  // index of the sighting -> of the plane
};

FoundMirrors FindMirrors(const MirrorScene& scene, int most) {
  FoundMirrors found;
  std::vector<MirrorPair> pairs;
  for (const auto& [frame, picture] : scene.pictures)
    for (int direct : picture.direct)
      for (int mirrored : picture.mirrored) pairs.push_back({direct, mirrored});
  while (!pairs.empty() && static_cast<int>(found.planes.size()) < most) {
    const auto plane = FindPlane(scene, pairs);
    if (!plane) break;
    const std::size_t before = pairs.size();
    const int index = static_cast<int>(found.planes.size());
    std::erase_if(pairs, [&](const MirrorPair& pair) {
      if (!(RmsOfPlane_px(scene, *plane, pair.direct, pair.mirrored) <
            RoughTolerance_px(scene.camera)))
        return false;
      found.mirror_of[pair.mirrored] = index;
      return true;
    });
    if (pairs.size() == before) break;
    found.planes.push_back(*plane);
  }
  // Where there is but one mirror, a board that only it shows is in that one: it helps the lens.
  if (found.planes.size() == 1)
    for (const auto& [frame, picture] : scene.pictures)
      if (picture.direct.empty() && picture.mirrored.size() == 1)
        found.mirror_of[picture.mirrored[0]] = 0;
  return found;
}

// A chessboard looks the same in a mirror, but for the order of its corners: taken for the wrong
// one of the two, it was counted from another corner.
BoardSighting SeenTheOtherWay(const BoardSpec& board, const BoardSighting& sighting) {
  const int columns = board.corner_columns(), rows = board.corner_rows();
  std::map<int, Eigen::Vector2d> points_px;
  for (std::size_t i = 0; i < sighting.corners.size(); ++i) {
    const int column = sighting.corners[i] % columns, row = sighting.corners[i] / columns;
    // Of the two reflections of the count that which has a dark square before its first corner.
    const int other = columns % 2 == 0 ? row * columns + columns - 1 - column
                                       : (rows - 1 - row) * columns + column;
    points_px[other] = sighting.points_px[i];
  }
  BoardSighting result = sighting;
  result.mirrored = !sighting.mirrored;
  result.corners.clear();
  result.points_px.clear();
  for (const auto& [corner, point_px] : points_px) {
    result.corners.push_back(corner);
    result.points_px.push_back(point_px);
  }
  return result;
}

// Whether the mirror would have the board stand behind it.
bool IsBehind(const MirrorScene& scene, const Plane& plane, int direct) {
  const BoardSpec& board = scene.board;
  const Eigen::Vector3d middle =
      (board.corner_in_board_mm(0) + board.corner_in_board_mm(board.num_corners() - 1)) / 2;
  const Rigid3d& pose = scene.poses.at(direct).front().cam_from_board;
  return plane.normal.dot(pose * middle) > plane.distance_mm;
}

// Of two chessboards in a picture the nearer one counts as seen directly, which it need not be. A
// plane explains the exchanged views as well, but for its glass: it then has the board behind it.
// Returns whether any two were exchanged.
bool ExchangeViews(const MirrorScene& scene, const FoundMirrors& found, CameraSightings& camera) {
  bool any = false;
  if (scene.board.kind != BoardKind::kChessboard) return any;
  for (const auto& [frame, picture] : scene.pictures) {
    if (picture.direct.size() != 1 || picture.mirrored.size() != 1) continue;
    const auto mirror = found.mirror_of.find(picture.mirrored[0]);
    if (mirror == found.mirror_of.end() ||
        !IsBehind(scene, found.planes[mirror->second], picture.direct[0]))
      continue;
    for (int index : {picture.direct[0], picture.mirrored[0]})
      camera.sightings[index] = SeenTheOtherWay(scene.board, camera.sightings[index]);
    any = true;
  }
  return any;
}

Mirror MirrorOf(const Plane& plane, int index, const MirrorOptions& options) {
  Mirror mirror;
  mirror.name = options.mirrors == 1 ? "mirror" : fmt::format("mirror{}", index + 1);
  mirror.normal_in_stage = plane.normal;
  mirror.distance_mm = plane.distance_mm;
  mirror.glass_mm = options.glass_mm;
  mirror.glass_index = options.glass_index;
  return mirror;
}

// The pose of the board that explains all of a picture's views best.
Rigid3d PlacePicture(const MirrorScene& scene, const FoundMirrors& found, const Picture& picture) {
  std::vector<Rigid3d> candidates;
  for (int direct : picture.direct)
    for (const PlanarPose& pose : scene.poses.at(direct)) candidates.push_back(pose.cam_from_board);
  for (int mirrored : picture.mirrored)
    for (const PlanarPose& pose : scene.poses.at(mirrored))
      candidates.push_back(
          Reflected(found.planes[found.mirror_of.at(mirrored)], pose.cam_from_board));
  const auto cost_of = [&](const Rigid3d& cam_from_board) {
    double cost = 0;
    const auto add = [&](int index, const Rigid3d& pose) {
      const BoardSighting& seen = scene.input->sightings[index];
      cost += std::min(
          1e3, RmsOfPose_px(scene.board, scene.camera.lens, seen.corners, seen.points_px, pose));
    };
    for (int direct : picture.direct) add(direct, cam_from_board);
    for (int mirrored : picture.mirrored)
      add(mirrored, Reflected(found.planes[found.mirror_of.at(mirrored)], cam_from_board));
    return cost;
  };
  return *std::min_element(
      candidates.begin(), candidates.end(),
      [&](const Rigid3d& a, const Rigid3d& b) { return cost_of(a) < cost_of(b); });
}

Network BuildNetwork(MirrorScene scene, const FoundMirrors& found, const MirrorOptions& options,
                     LeftOutSightings& set_aside) {
  Network network;
  network.board = scene.board;
  network.array.cameras = {scene.camera};
  for (int i = 0; i < static_cast<int>(found.planes.size()); ++i)
    network.array.mirrors.push_back(MirrorOf(found.planes[i], i, options));
  for (auto& of_frame : scene.pictures) {
    Picture& picture = of_frame.second;
    std::erase_if(picture.mirrored, [&](int index) {
      if (found.mirror_of.contains(index)) return false;
      set_aside[{0, index}] =
          picture.direct.empty()
              ? "the picture shows the board in mirrors alone, so that nothing tells in which"
              : "what the mirror shows does not fit the board beside it; did the board or the "
                "mirror move, or is it another mirror?";
      return true;
    });
    if (picture.direct.empty() && picture.mirrored.empty()) continue;
    const int placement = static_cast<int>(network.placements.size());
    network.placements.push_back({PlacePicture(scene, found, picture), 0});
    const auto add = [&](int index, int mirror) {
      const BoardSighting& sighting = scene.input->sightings[index];
      network.sightings.push_back(
          {{0, mirror}, placement, 0, index, sighting.corners, sighting.points_px});
    };
    for (int direct : picture.direct) add(direct, -1);
    for (int mirrored : picture.mirrored) add(mirrored, found.mirror_of.at(mirrored));
  }
  return network;
}

}  // namespace

Result<Network> StartMirrorNetwork(const BoardSpec& board, const CameraSightings& input,
                                   const Camera& camera, const MirrorOptions& options,
                                   LeftOutSightings& set_aside) {
  CameraSightings sightings = input;
  MirrorScene scene = MakeScene(board, sightings, camera, set_aside);
  FoundMirrors found = FindMirrors(scene, options.mirrors);
  if (ExchangeViews(scene, found, sightings)) {
    scene = MakeScene(board, sightings, camera, set_aside);
    found = FindMirrors(scene, options.mirrors);
  }
  if (static_cast<int>(found.planes.size()) < options.mirrors)
    return Fail(fmt::format(
        "{}: the pictures show {} plane mirror{}, not {}; the board beside a mirror and its "
        "reflection must fit one plane that stands still in all pictures",
        input.camera, found.planes.size(), found.planes.size() == 1 ? "" : "s", options.mirrors));
  Network network = BuildNetwork(std::move(scene), found, options, set_aside);
  SetAsideUnplaced({&input, 1}, network, set_aside);
  return network;
}

}  // namespace articap
