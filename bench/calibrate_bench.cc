// SPDX-License-Identifier: MIT
// Calibration without the detection of boards: bundle adjustment of a camera rig on one thread, and
// a lens from thirty pictures beside OpenCV's calibrateCamera on the same corners.
#include <benchmark/benchmark.h>

#include <opencv2/calib3d.hpp>
#include <random>

#include "calib/lens_model.h"
#include "calib/lens_solver.h"
#include "calib/network.h"
#include "tests/calib/network_scene.h"

namespace articap {
namespace {

constexpr double kNoise_px = 0.1;

// The truth, disturbed as far as a start from planar poses may be.
Rigid3d Disturbed(const Rigid3d& pose, std::mt19937& random) {
  std::normal_distribution<double> angle_rad(0, 0.01), shift_mm(0, 5);
  const Eigen::Vector3d w{angle_rad(random), angle_rad(random), angle_rad(random)};
  const Eigen::Vector3d t{shift_mm(random), shift_mm(random), shift_mm(random)};
  return {Eigen::Quaterniond(Eigen::AngleAxisd(w.norm(), w.normalized())) * pose.rotation,
          pose.translation_mm + t};
}

Network DisturbedNetwork() {
  const NetworkScene scene = RigScene(1, 4, 100);
  std::mt19937 random(1);
  Network network;
  network.board = scene.board;
  network.array = scene.array;
  for (std::size_t i = 0; i < network.array.cameras.size(); ++i) {
    Camera& camera = network.array.cameras[i];
    camera.lens.fx_px *= 1.02;
    camera.lens.fy_px *= 1.02;
    camera.lens.distortion = {};
    if (i > 0) camera.cam_from_stage = Disturbed(camera.cam_from_stage, random);
  }
  for (const Rigid3d& pose : scene.stage_from_board)
    network.placements.push_back({Disturbed(pose, random), 0});
  const std::vector<CameraSightings> seen = SeeBoards(scene, kNoise_px, 1);
  for (int camera = 0; camera < static_cast<int>(seen.size()); ++camera)
    for (const BoardSighting& sighting : seen[camera].sightings)
      network.sightings.push_back({{camera, -1},
                                   static_cast<int>(sighting.frame),
                                   0,
                                   0,
                                   sighting.corners,
                                   sighting.points_px});
  return network;
}

void BM_BundleAdjustment(benchmark::State& state) {
  const Network network = DisturbedNetwork();
  AdjustOptions options;
  options.lenses.assign(4, FreedomOf(LensModel::kBrown5, {}));
  options.huber_px = 1;
  AdjustedNetwork adjusted;
  for (auto _ : state) adjusted = Adjust(network, options);
  std::size_t residuals = 0;
  for (const auto& of_sighting : adjusted.residuals_px) residuals += 2 * of_sighting.size();
  state.counters["residuals"] = static_cast<double>(residuals);
  state.counters["steps"] = adjusted.iterations;
  state.counters["rms_px"] = adjusted.rms_px();
}
BENCHMARK(BM_BundleAdjustment)->Unit(benchmark::kMillisecond);

const CameraSightings& ThirtyPictures() {
  static const CameraSightings seen = SeeBoards(LensScene(1, 30), kNoise_px, 1)[0];
  return seen;
}

void BM_Lens(benchmark::State& state) {
  const BoardSpec board = LensScene(1, 1).board;
  double rms_px = 0;
  for (auto _ : state) rms_px = SolveLens(board, ThirtyPictures(), {})->adjusted.rms_px();
  state.counters["rms_px"] = rms_px;
}
BENCHMARK(BM_Lens)->Unit(benchmark::kMillisecond);

void BM_LensByOpenCv(benchmark::State& state) {
  const BoardSpec board = LensScene(1, 1).board;
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> points;
  for (const BoardSighting& sighting : ThirtyPictures().sightings) {
    boards.emplace_back();
    points.emplace_back();
    for (std::size_t i = 0; i < sighting.corners.size(); ++i) {
      const Eigen::Vector3f corner = board.corner_in_board_mm(sighting.corners[i]).cast<float>();
      const Eigen::Vector2f point = sighting.points_px[i].cast<float>();
      boards.back().emplace_back(corner.x(), corner.y(), 0);
      points.back().emplace_back(point.x(), point.y());
    }
  }
  double rms_px = 0;
  for (auto _ : state) {
    cv::Mat camera, distortion;
    std::vector<cv::Mat> rotations, translations;
    rms_px = cv::calibrateCamera(boards, points, {640, 480}, camera, distortion, rotations,
                                 translations);
  }
  state.counters["rms_px"] = rms_px;
}
BENCHMARK(BM_LensByOpenCv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace articap
