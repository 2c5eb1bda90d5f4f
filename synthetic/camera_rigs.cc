// SPDX-License-Identifier: MIT
#include "synthetic/camera_rigs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <system_error>

#include "core/check.h"
#include "synthetic/random.h"
#include "synthetic/random_streams.h"

namespace articap {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

// As lenses of this kind leave the factory: a little barrel, hardly any tangential distortion, the
// axis a few pixels beside the middle.
Lens RandomLens(const CameraModel& model, RandomGenerator& random) {
  Lens lens;
  lens.fx_px = model.focal_px * random.Uniform(0.98, 1.02);
  lens.fy_px = lens.fx_px * random.Uniform(0.999, 1.001);
  lens.cx_px = 0.5 * (model.width - 1) + random.Uniform(-12, 12);
  lens.cy_px = 0.5 * (model.height - 1) + random.Uniform(-12, 12);
  lens.distortion[Lens::kK1] = random.Uniform(-0.22, -0.08);
  lens.distortion[Lens::kK2] = random.Uniform(0.05, 0.15);
  lens.distortion[Lens::kP1] = random.Uniform(-0.001, 0.001);
  lens.distortion[Lens::kP2] = random.Uniform(-0.001, 0.001);
  return lens;
}

Camera MakeCamera(std::string name, const LookAt& look_at, const CameraModel& model,
                  RandomGenerator& random) {
  Camera camera;
  camera.name = std::move(name);
  camera.width = model.width;
  camera.height = model.height;
  camera.lens = RandomLens(model, random);
  camera.cam_from_stage = CamFromStage(look_at);
  return camera;
}

// A mirror at 45 degrees beside the left (side 1) or right (side -1) cheek, which shows its side of
// the face from the ear to before the nose.
void AddMirror(const std::string& name, double side, double glass_mm, RandomGenerator& random,
               SyntheticCameras& cameras) {
  MirrorOutline outline;
  outline.center_in_stage_mm = {side * 190, 0, 10};
  outline.width_mm = 250;
  Mirror mirror;
  mirror.name = name;
  mirror.camera = 0;
  mirror.glass_mm = glass_mm;
  // From +z to the face; a carpenter's 45 degrees are a degree off.
  mirror.normal_in_stage =
      (Eigen::Vector3d(side, 0, -1).normalized() + 0.01 * random.NormalVector()).normalized();
  mirror.distance_mm = mirror.normal_in_stage.dot(outline.center_in_stage_mm);
  cameras.array.mirrors.push_back(mirror);
  cameras.outlines.push_back(outline);
}

}  // namespace

std::vector<RenderMirror> SyntheticCameras::RenderMirrors() const {
  ARTICAP_CHECK_EQ(outlines.size(), array.mirrors.size());
  std::vector<RenderMirror> mirrors;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const Mirror& mirror = array.mirrors[i];
    const MirrorOutline& outline = outlines[i];
    const double off_plane_mm =
        mirror.normal_in_stage.dot(outline.center_in_stage_mm) - mirror.distance_mm;
    ARTICAP_CHECK_LT(std::abs(off_plane_mm), 1e-9);
    mirrors.push_back({.center_mm = outline.center_in_stage_mm,
                       .normal = mirror.normal_in_stage,
                       .up = outline.up_in_stage,
                       .width_mm = outline.width_mm,
                       .height_mm = outline.height_mm,
                       .glass_mm = mirror.glass_mm,
                       .glass_index = mirror.glass_index,
                       .frame_mm = outline.frame_mm});
  }
  return mirrors;
}

Rigid3d CamFromStage(const LookAt& look_at_in_stage) {
  const Eigen::Vector3d ahead = (look_at_in_stage.target_mm - look_at_in_stage.eye_mm).normalized();
  const Eigen::Vector3d right = ahead.cross(look_at_in_stage.up).normalized();
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  const Eigen::Quaterniond cam_from_stage(rotation);
  return {cam_from_stage, -(cam_from_stage * look_at_in_stage.eye_mm)};
}

SyntheticCameras RingOfCameras(int num_cameras, std::uint64_t seed, const CameraModel& model) {
  ARTICAP_CHECK_GT(num_cameras, 0);
  constexpr double kDistance_mm = 800, kHalfArc_rad = 50 * kRadPerDeg;
  constexpr double kElevation_rad = 12 * kRadPerDeg;
  RandomGenerator random(seed, random_streams::kCameras);
  SyntheticCameras cameras;
  cameras.array.source = fmt::format("a synthetic ring of {} cameras, seed {}", num_cameras, seed);
  for (int i = 0; i < num_cameras; ++i) {
    const double part = num_cameras == 1 ? 0 : 2.0 * i / (num_cameras - 1) - 1;
    const double yaw = part * kHalfArc_rad + random.Uniform(-0.03, 0.03);
    const double elevation = (i % 2 == 0 ? 1 : -1) * kElevation_rad + random.Uniform(-0.03, 0.03);
    const Eigen::Vector3d towards_camera(std::sin(yaw) * std::cos(elevation), std::sin(elevation),
                                         std::cos(yaw) * std::cos(elevation));
    const double distance_mm = kDistance_mm + random.Uniform(-20, 20);
    const LookAt look_at{distance_mm * towards_camera, 8 * random.NormalVector()};
    cameras.array.cameras.push_back(
        MakeCamera(fmt::format("camera{}", i + 1), look_at, model, random));
  }
  return cameras;
}

SyntheticCameras MirrorSetUp(double glass_mm, std::uint64_t seed, const CameraModel& model) {
  RandomGenerator random(seed, random_streams::kCameras);
  SyntheticCameras cameras;
  cameras.array.source = fmt::format("a synthetic camera with a mirror, seed {}", seed);
  // The camera looks between the face and the mirror, so that both are in the picture.
  const LookAt look_at{{95, 10, 700}, Eigen::Vector3d(95, 0, 0) + 3 * random.NormalVector()};
  cameras.array.cameras = {MakeCamera("front", look_at, model, random)};
  AddMirror("left", 1, glass_mm, random, cameras);
  return cameras;
}

SyntheticCameras TwoMirrorSetUp(double glass_mm, std::uint64_t seed, const CameraModel& model) {
  RandomGenerator random(seed, random_streams::kCameras);
  SyntheticCameras cameras;
  cameras.array.source = fmt::format("a synthetic camera with two mirrors, seed {}", seed);
  const LookAt look_at{{0, 10, 850}, 3 * random.NormalVector()};
  cameras.array.cameras = {MakeCamera("front", look_at, model, random)};
  AddMirror("left", 1, glass_mm, random, cameras);
  AddMirror("right", -1, glass_mm, random, cameras);
  return cameras;
}

Result<SyntheticCameras> CamerasByName(const std::string& name, double glass_mm, std::uint64_t seed,
                                       const CameraModel& model) {
  constexpr int kMostCameras = 16;
  if (name == "mirror") return MirrorSetUp(glass_mm, seed, model);
  if (name == "two-mirrors") return TwoMirrorSetUp(glass_mm, seed, model);
  int num_cameras = 0;
  const std::string_view ring = "ring";
  if (name.starts_with(ring)) {
    const char* const end = name.data() + name.size();
    const auto parsed = std::from_chars(name.data() + ring.size(), end, num_cameras);
    if (parsed.ec == std::errc() && parsed.ptr == end && num_cameras >= 1 &&
        num_cameras <= kMostCameras)
      return RingOfCameras(num_cameras, seed, model);
  }
  return Fail(
      fmt::format("there is no set-up of cameras '{}'; there are mirror, two-mirrors, and "
                  "ring1 to ring{}",
                  name, kMostCameras));
}

}  // namespace articap
