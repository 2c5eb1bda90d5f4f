// SPDX-License-Identifier: MIT
#include "synthetic/board_session.h"

namespace articap {
namespace {

// Halfway between the camera and the mirror on a side of the face (1: left), so that both see the
// front.
BoardPoseOptions BeforeMirror(double side) {
  return {.center_in_stage_mm = {-10 * side, 0, 10},
          .reach_mm = {30, 40, 40},
          .facing_in_stage = {side, 0, 1},
          .most_tilt_deg = 25,
          .whole_in_views = 2};
}

}  // namespace

BoardSession BoardSessionFor(const SyntheticCameras& cameras) {
  if (cameras.array.mirrors.empty()) {
    BoardPoseOptions shared;
    if (cameras.array.cameras.size() > 1) shared.whole_in_views = 2;
    return {{.columns = 9, .rows = 6, .square_mm = 20}, {shared}};
  }
  BoardSession session;
  session.board = {.columns = 8, .rows = 5, .square_mm = 12};
  const BoardPoseOptions directly = {.reach_mm = {170, 90, 150}};
  for (std::size_t turn = 0; turn < 2; ++turn)
    for (const Mirror& mirror : cameras.array.mirrors)
      session.ways.push_back(BeforeMirror(mirror.normal_in_stage.x() > 0 ? 1 : -1));
  session.ways.insert(session.ways.end(), cameras.array.mirrors.size(), directly);
  return session;
}

Result<std::vector<Rigid3d>> BoardPosesOf(const Studio& studio, const BoardSession& session,
                                          int num_pictures, std::uint64_t seed) {
  const BoardPattern pattern = SquaresOf(session.board);
  const int num_ways = static_cast<int>(session.ways.size());
  std::vector<Rigid3d> poses(num_pictures);
  for (int way = 0; way < num_ways; ++way) {
    const int num_poses = (num_pictures - way + num_ways - 1) / num_ways;
    const auto of_way = RandomBoardPoses(studio, session.board, pattern, session.ways[way],
                                         num_poses, seed + static_cast<std::uint64_t>(way));
    if (!of_way) return tl::unexpected(of_way.error());
    for (int i = 0; i < num_poses; ++i) poses[way + i * num_ways] = (*of_way)[i];
  }
  return poses;
}

SensorOptions MachineVision() {
  SensorOptions sensor;
  sensor.blur_px = 0.7;
  sensor.vignetting = 0.15;
  sensor.black_level = 0.01;
  return sensor;
}

std::uint64_t PictureSeed(std::uint64_t seed, int camera, int picture) {
  return seed * 1000003 + static_cast<std::uint64_t>(camera) * 10007 +
         static_cast<std::uint64_t>(picture);
}

}  // namespace articap
