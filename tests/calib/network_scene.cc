// SPDX-License-Identifier: MIT
#include "tests/calib/network_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace articap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double Between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Facing the camera that looks along z, then tilted about an axis in the picture and turned in it.
Eigen::Quaterniond TiltedBoard(std::mt19937& random, double most_rad) {
  const double direction = Between(random, 0, 2 * std::numbers::pi);
  const double tilt = Between(random, 0.3, 1) * most_rad;
  const double turn = Between(random, -0.3, 0.3);
  return Eigen::AngleAxisd(tilt, Eigen::Vector3d{std::cos(direction), std::sin(direction), 0}) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
}

Eigen::Vector3d MiddleOf(const BoardSpec& board) {
  return (board.corner_in_board_mm(0) + board.corner_in_board_mm(board.num_corners() - 1)) / 2;
}

std::optional<BoardSighting> SeeBoard(const NetworkScene& scene, const View& view,
                                      const Rigid3d& stage_from_board, double noise_px,
                                      std::mt19937& random) {
  const Camera& camera = scene.array.cameras[view.camera];
  // From behind, or too flat, nobody recognises a board.
  const Rigid3d cam_from_board = camera.cam_from_stage * stage_from_board;
  const Eigen::Vector3d towards_board = (cam_from_board * MiddleOf(scene.board)).normalized();
  if (view.mirror < 0 &&
      towards_board.dot(cam_from_board.rotation * Eigen::Vector3d::UnitZ()) < 0.35)
    return std::nullopt;
  std::normal_distribution<double> noise(0, noise_px);
  BoardSighting sighting;
  sighting.mirrored = view.mirror >= 0;
  for (int corner = 0; corner < scene.board.num_corners(); ++corner) {
    const auto point =
        Project(scene.array, view, stage_from_board * scene.board.corner_in_board_mm(corner));
    if (!point || point->x() < 0 || point->y() < 0 || point->x() > camera.width - 1 ||
        point->y() > camera.height - 1)
      return std::nullopt;
    sighting.corners.push_back(corner);
    sighting.points_px.push_back(*point + Eigen::Vector2d{noise(random), noise(random)});
  }
  return sighting;
}

}  // namespace

NetworkScene LensScene(unsigned seed, int num_views) {
  std::mt19937 random(seed);
  NetworkScene scene;
  scene.board = ParseBoardSpec("chessboard:9x6:25").value();
  Camera camera;
  camera.name = "left";
  camera.width = 640;
  camera.height = 480;
  camera.lens = {533, 534.5, 341, 235, {-0.28, 0.09, 0.001, -0.0005, -0.01, 0, 0, 0}};
  scene.array.cameras = {camera};
  while (static_cast<int>(scene.stage_from_board.size()) < num_views) {
    const double z_mm = Between(random, 350, 600);
    const Eigen::Vector3d at{Between(random, -0.35, 0.35) * z_mm,
                             Between(random, -0.25, 0.25) * z_mm, z_mm};
    Rigid3d pose{TiltedBoard(random, 35 * kDegree), {}};
    pose.translation_mm = at - pose.rotation * MiddleOf(scene.board);
    std::mt19937 unused(0);
    if (SeeBoard(scene, {0, -1}, pose, 0, unused)) scene.stage_from_board.push_back(pose);
  }
  return scene;
}

NetworkScene RigScene(unsigned seed, int num_cameras, int num_placements) {
  std::mt19937 random(seed);
  NetworkScene scene;
  scene.board = ParseBoardSpec("chessboard:9x6:20").value();
  const double arc = (num_cameras == 2 ? 30 : 120) * kDegree;
  const Eigen::Vector3d middle{0, 0, 800};  // of the volume, in the first camera's frame
  for (int i = 0; i < num_cameras; ++i) {
    Camera camera;
    camera.name = fmt::format("cam{}", i);
    camera.width = 1280;
    camera.height = 720;
    const double focal_px = Between(random, 1150, 1250);
    camera.lens = {focal_px,
                   focal_px * Between(random, 0.998, 1.002),
                   640 + Between(random, -15, 15),
                   360 + Between(random, -15, 15),
                   {Between(random, -0.2, -0.1), Between(random, 0.02, 0.08), 0.0008, -0.0006, 0}};
    // Turned about the vertical axis through the middle; the later ones also a little up or down.
    const Eigen::Quaterniond rotation =
        Eigen::AngleAxisd(i == 0 ? 0 : Between(random, -8, 8) * kDegree, Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(arc * i / (num_cameras - 1), Eigen::Vector3d::UnitY());
    camera.cam_from_stage = {rotation, middle - rotation * middle};
    scene.array.cameras.push_back(camera);
  }
  for (int i = 0; i < num_placements; ++i) {
    const Camera& facing = scene.array.cameras[i % num_cameras];
    const Rigid3d stage_from_cam = facing.cam_from_stage.Inverse();
    Rigid3d pose{stage_from_cam.rotation * TiltedBoard(random, 40 * kDegree), {}};
    const Eigen::Vector3d at =
        middle + Eigen::Vector3d{Between(random, -100, 100), Between(random, -80, 80),
                                 Between(random, -100, 100)};
    pose.translation_mm = at - pose.rotation * MiddleOf(scene.board);
    scene.stage_from_board.push_back(pose);
  }
  return scene;
}

NetworkScene MirrorScene(unsigned seed, int num_placements, double glass_mm) {
  std::mt19937 random(seed);
  NetworkScene scene;
  scene.board = ParseBoardSpec("chessboard:9x6:12").value();
  Camera camera;
  camera.name = "camera";
  camera.width = 1280;
  camera.height = 720;
  camera.lens = {1500, 1503, 645, 352, {-0.12, 0.05, 0.0005, -0.0003, 0, 0, 0, 0}};
  scene.array.cameras = {camera};
  Mirror mirror;
  mirror.name = "mirror";
  // Stands to the right of the board, and shows its right side. Through (150, 0, 800).
  mirror.normal_in_stage = Eigen::Vector3d{std::sin(45 * kDegree), 0, std::cos(45 * kDegree)};
  mirror.distance_mm = mirror.normal_in_stage.dot(Eigen::Vector3d{150, 0, 800});
  mirror.glass_mm = glass_mm;
  scene.array.mirrors = {mirror};
  std::mt19937 unused(0);
  while (static_cast<int>(scene.stage_from_board.size()) < num_placements) {
    // Turned halfway towards the mirror, so that both ways show it.
    Rigid3d pose{Eigen::AngleAxisd(Between(random, -60, -30) * kDegree, Eigen::Vector3d::UnitY()) *
                     TiltedBoard(random, 20 * kDegree),
                 {}};
    const Eigen::Vector3d at{Between(random, -180, 20), Between(random, -90, 90),
                             Between(random, 620, 800)};
    pose.translation_mm = at - pose.rotation * MiddleOf(scene.board);
    if (SeeBoard(scene, {0, -1}, pose, 0, unused) && SeeBoard(scene, {0, 0}, pose, 0, unused))
      scene.stage_from_board.push_back(pose);
  }
  return scene;
}

std::vector<CameraSightings> SeeBoards(const NetworkScene& scene, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<CameraSightings> all;
  for (const Camera& camera : scene.array.cameras)
    all.push_back({camera.name, camera.width, camera.height, {}, std::nullopt});
  for (std::size_t placement = 0; placement < scene.stage_from_board.size(); ++placement)
    for (const View& view : scene.array.views())
      if (auto sighting =
              SeeBoard(scene, view, scene.stage_from_board[placement], noise_px, random)) {
        sighting->source = fmt::format("{:03}.png", placement);
        sighting->frame = static_cast<std::int64_t>(placement);
        all[view.camera].sightings.push_back(*std::move(sighting));
      }
  return all;
}

}  // namespace articap
