// SPDX-License-Identifier: MIT
#include "tests/report/sample_calibrations.h"

#include <random>

#include "calib/calibration_json.h"
#include "calib/lens_calibration.h"
#include "calib/mirror_calibration.h"
#include "calib/rig_calibration.h"
#include "calib/wand_calibration.h"
#include "core/check.h"
#include "tests/calib/network_scene.h"
#include "tests/calib/wand_scene.h"

namespace articap {
namespace {

constexpr double kNoise_px = 0.1;

template <class Output>
std::string JsonOf(const Result<StageResult<Output>>& result) {
  if (!result) throw CheckError("a sample is refused: " + result.error().message);
  return CalibrationJson(result->output, result->report);
}

void Displace(BoardSighting& sighting, int corner, const Eigen::Vector2d& by_px) {
  sighting.points_px[corner] += by_px;
}

// As if the board had moved while the picture was taken.
void Blur(BoardSighting& sighting, double noise_px, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  for (Eigen::Vector2d& point : sighting.points_px)
    point += Eigen::Vector2d{noise(random), noise(random)};
}

}  // namespace

std::string SampleLensJson() {
  const NetworkScene scene = LensScene(7, 34);
  CameraSightings camera = SeeBoards(scene, kNoise_px, 3)[0];
  camera.camera = "left & <b>lower</b>";
  std::erase_if(camera.sightings, [](const BoardSighting& sighting) {
    for (const Eigen::Vector2d& point : sighting.points_px)
      if (point.x() > 560) return true;
    return false;
  });
  Displace(camera.sightings[4], 12, {3.1, -1.4});
  Displace(camera.sightings[4], 13, {2.6, -1.0});
  Blur(camera.sightings[9], 1.2, 5);
  camera.sightings[9].source = "</script><img src=x onerror=alert(1)>.png";
  return JsonOf(CalibrateLens(scene.board, camera, {}));
}

std::string SampleRigJson() {
  const NetworkScene scene = RigScene(2, 4, 40);
  return JsonOf(CalibrateRig(scene.board, SeeBoards(scene, kNoise_px, 4), {}, {}));
}

std::string SampleMirrorJson() {
  const NetworkScene scene = MirrorScene(5, 24);
  return JsonOf(CalibrateMirror(scene.board, SeeBoards(scene, kNoise_px, 11)[0], {}, {}));
}

std::string SampleWandJson() {
  WandOptions options;
  options.length_mm = kWandLength_mm;
  return JsonOf(CalibrateWand(WaveWand(4, 400, kNoise_px, 1).videos, options));
}

std::string SampleBlurredJson() {
  const NetworkScene scene = LensScene(3, 12);
  return JsonOf(CalibrateLens(scene.board, SeeBoards(scene, 1.5, 6)[0], {}));
}

}  // namespace articap
