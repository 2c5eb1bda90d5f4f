// SPDX-License-Identifier: MIT
#include "synthetic/wand_scene.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "render/shapes.h"
#include "synthetic/random.h"
#include "synthetic/random_streams.h"

namespace articap {

std::array<Eigen::Vector3d, 2> Wand::CentersAt(const Rigid3d& stage_from_wand) const {
  return {stage_from_wand * Eigen::Vector3d(-length_mm / 2, 0, 0),
          stage_from_wand * Eigen::Vector3d(length_mm / 2, 0, 0)};
}

Scene WandScene(const Studio& studio, const Wand& wand, const Rigid3d& stage_from_wand) {
  Scene scene = studio.EmptyScene();
  scene.lights.clear();
  scene.ambient = Eigen::Vector3f::Constant(0.05f);
  scene.background = Eigen::Vector3f::Constant(0.03f);
  const auto [left, right] = wand.CentersAt(stage_from_wand);
  const Eigen::Vector3f bright = Eigen::Vector3f::Constant(0.8f);
  const Material shines_back = {.gloss = 0, .glow = 1};
  scene.spheres = {{left, wand.ball_radius_mm, bright, shines_back},
                   {right, wand.ball_radius_mm, bright, shines_back}};
  scene.meshes = {RodMesh(left, right, wand.rod_radius_mm, Eigen::Vector3f::Constant(0.1f))};
  return scene;
}

std::vector<ViewTruth> TruthOfWand(const Studio& studio, const Wand& wand,
                                   const Rigid3d& stage_from_wand) {
  const auto centers = wand.CentersAt(stage_from_wand);
  return studio.TruthOf(WandScene(studio, wand, stage_from_wand), {centers.begin(), centers.end()},
                        wand.ball_radius_mm);
}

WandPath::WandPath(std::uint64_t seed, const Eigen::Vector3d& reach_mm) : reach_mm_(reach_mm) {
  RandomGenerator random(seed, random_streams::kWandPath);
  for (Swing& swing : swings_) {
    swing.frequency_hz = random.Uniform(0.2, 0.6);
    swing.phase_rad = random.Uniform(0, 2 * std::numbers::pi);
  }
}

double WandPath::Swing::At(double time_s) const {
  return std::sin(2 * std::numbers::pi * frequency_hz * time_s + phase_rad);
}

Rigid3d WandPath::StageFromWandAt(double time_s) const {
  const auto swings_at = [&](int first) {
    return Eigen::Vector3d(swings_[first].At(time_s), swings_[first + 1].At(time_s),
                           swings_[first + 2].At(time_s));
  };
  // Swings about y and z point the rod in all directions.
  const Eigen::Vector3d angles_rad = std::numbers::pi * swings_at(3);
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(angles_rad.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(angles_rad.z(), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(angles_rad.x(), Eigen::Vector3d::UnitX());
  return {rotation, reach_mm_.cwiseProduct(swings_at(0))};
}

}  // namespace articap
