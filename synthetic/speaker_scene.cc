// SPDX-License-Identifier: MIT
#include "synthetic/speaker_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/check.h"
#include "core/mesh.h"
#include "render/rig_view.h"

namespace articap {
namespace {

constexpr std::string_view kSpectacles = "spectacles";

// Whether each vertex belongs to the spectacles.
std::vector<bool> SpectacleVertices(const RigDefinition& rig) {
  std::vector<bool> belongs(rig.mesh.vertices.size(), false);
  for (std::size_t i = 0; i < rig.mesh.triangles.size(); ++i)
    if (rig.part_names[rig.triangle_part[i]] == kSpectacles)
      for (const int corner : {0, 1, 2}) belongs[rig.mesh.triangles[i][corner]] = true;
  return belongs;
}

// Markers that a rig's spectacles bring with them get the colour of the frame, its darkest: the
// dots are what is to be seen.
FaceRig WithoutOwnMarkers(const FaceRig& rig) {
  RigDefinition definition = rig.definition();
  const std::vector<bool> belongs = SpectacleVertices(definition);
  Eigen::Vector3f darkest = Eigen::Vector3f::Ones();
  for (std::size_t i = 0; i < belongs.size(); ++i)
    if (belongs[i] && definition.colors[i].sum() < darkest.sum()) darkest = definition.colors[i];
  for (std::size_t i = 0; i < belongs.size(); ++i)
    if (belongs[i]) definition.colors[i] = darkest;
  Result<FaceRig> plain = FaceRig::Create(std::move(definition));
  ARTICAP_CHECK(plain.has_value());
  return *std::move(plain);
}

bool WearsSpectacles(const FaceRig& rig, const SyntheticTake& take) {
  const std::vector<bool> belongs = SpectacleVertices(rig.definition());
  return std::any_of(
      take.true_attachments.begin(), take.true_attachments.end(),
      [&](const VirtualMarker& attachment) { return belongs[attachment.triangle[0]]; });
}

// Weights of the frames -1, 0, 1 and 2 at a time in [0, 1) (Catmull and Rom 1974).
Eigen::Vector4d CubicWeights(double t) {
  return {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t),
          t * (0.5 + t * (2 - 1.5 * t)), t * t * (-0.5 + 0.5 * t)};
}

// Four frames and their weights; beyond its ends a take stays as it is there.
struct Neighbours {
  std::array<int, 4> frames;
  Eigen::Vector4d weights;
};

Neighbours NeighboursOf(double frame, int num_frames) {
  const double place = std::clamp(frame, 0.0, num_frames - 1.0);
  const int before = static_cast<int>(std::floor(place));
  Neighbours neighbours{{}, CubicWeights(place - before)};
  for (int i = 0; i < 4; ++i) neighbours.frames[i] = std::clamp(before - 1 + i, 0, num_frames - 1);
  return neighbours;
}

Eigen::VectorXd ParametersAt(const ParameterTrack& track, const Neighbours& neighbours) {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(track.num_parameters());
  for (int i = 0; i < 4; ++i)
    for (int parameter = 0; parameter < track.num_parameters(); ++parameter)
      parameters[parameter] +=
          neighbours.weights[i] * track.values(neighbours.frames[i], parameter);
  return parameters;
}

Rigid3d StageFromHeadAt(const HeadPoseTrack& track, const Neighbours& neighbours) {
  const auto stage_from_head = [&](int neighbour) {
    return track.poses[neighbours.frames[neighbour]].head_from_stage.Inverse();
  };
  const Eigen::Vector4d here = stage_from_head(1).rotation.coeffs();
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const Rigid3d pose = stage_from_head(i);
    // A quaternion and its negative are the same rotation.
    const double same_side = pose.rotation.coeffs().dot(here) < 0 ? -1 : 1;
    rotation += neighbours.weights[i] * same_side * pose.rotation.coeffs();
    translation_mm += neighbours.weights[i] * pose.translation_mm;
  }
  return {Eigen::Quaterniond(rotation).normalized(), translation_mm};
}

}  // namespace

void VisitOptions(SpeakerLookOptions& options, OptionVisitor& visit) {
  visit.Enumeration("dots", options.dots, {"disc", "ball", "hemisphere"},
                    "flat stickers, balls that rest on the skin, or halves of balls");
  visit("dot_diameter_mm", options.dot_diameter_mm, "of a dot; mm");
  visit("retro_reflective", options.retro_reflective,
        "dots that shine in a dark room; else white ones in the light of a room");
  visit("glints", options.glints,
        "wet and greasy places that mirror the lamp: spots that are no dots");
  visit("diffuse_light", options.diffuse_light,
        "part of the light that comes from all sides; the rest is a lamp's and throws shadows");
  visit("light_drift", options.light_drift, "part by which the light slowly rises and falls");
  visit("drift_period_s", options.drift_period_s, "how long that takes; s");
  visit("light_flicker", options.light_flicker, "part by which the light flickers");
  visit("flicker_hz", options.flicker_hz, "how often a second");
}

Result<void> CheckOptions(const SpeakerLookOptions& options) {
  if (auto positive = RequirePositive({{"dot_diameter_mm", options.dot_diameter_mm},
                                       {"drift_period_s", options.drift_period_s}});
      !positive)
    return positive;
  if (auto valid = RequireNotNegative({{"light_drift", options.light_drift},
                                       {"light_flicker", options.light_flicker},
                                       {"flicker_hz", options.flicker_hz}});
      !valid)
    return valid;
  if (!(options.diffuse_light >= 0 && options.diffuse_light <= 1))
    return Fail(
        fmt::format("diffuse_light is {}; it must be between 0 and 1", options.diffuse_light));
  if (options.light_drift + options.light_flicker > 1)
    return Fail(
        "light_drift and light_flicker are more than 1 together; there is no negative light");
  return {};
}

MarkerSet WithDots(MarkerSet set, const SpeakerLookOptions& look) {
  for (MarkerRole& role : set.markers)
    role.offset_mm = look.dots == DotKind::kBall ? look.dot_diameter_mm / 2 : 0;
  return set;
}

const Eigen::Vector3d& SpeakerScene::center_mm(int dot) const {
  return scene.discs.empty() ? scene.spheres.at(dot).center_mm : scene.discs.at(dot).center_mm;
}

double SpeakerScene::radius_mm(int dot) const {
  return scene.discs.empty() ? scene.spheres.at(dot).radius_mm : scene.discs.at(dot).radius_mm;
}

FilmedSpeaker::FilmedSpeaker(const FaceRig& rig, SyntheticTake take, const SpeakerLookOptions& look)
    : speaker_(WithoutOwnMarkers(rig).WithIdentity(take.identity_values())),
      take_(std::move(take)),
      look_(look),
      evaluator_(speaker_, take_.true_attachments),
      wears_spectacles_(WearsSpectacles(speaker_, take_)) {
  ARTICAP_CHECK_GT(take_.truth.num_frames(), 0);
}

SpeakerScene FilmedSpeaker::At(double frame, const Studio& studio) const {
  const Neighbours neighbours = NeighboursOf(frame, take_.truth.num_frames());
  const Eigen::VectorXd parameters = ParametersAt(take_.truth, neighbours);
  const Rigid3d stage_from_head = StageFromHeadAt(take_.true_pose, neighbours);
  const Sim3d head_from_rig = take_.rig_from_head.Inverse();
  const auto to_stage = [&](const Eigen::Vector3d& point_in_rig) {
    return Eigen::Vector3d(stage_from_head * (head_from_rig * point_in_rig));
  };

  std::vector<Eigen::Vector3d> posed_in_stage_mm;
  for (const Eigen::Vector3d& vertex : speaker_.Evaluate(parameters))
    posed_in_stage_mm.push_back(to_stage(vertex));
  const auto pose =
      evaluator_.PoseOf({parameters.data(), static_cast<std::size_t>(parameters.size())});
  std::vector<Eigen::Vector3d> centers_mm;
  for (int marker = 0; marker < evaluator_.num_markers(); ++marker)
    centers_mm.push_back(to_stage(evaluator_.Position(pose, marker)));

  SpeakerScene filmed;
  filmed.scene = SceneOf(speaker_, posed_in_stage_mm, {.show_spectacles = wears_spectacles_});
  filmed.scene.mirrors = studio.cameras().RenderMirrors();
  AddDots(posed_in_stage_mm, centers_mm, filmed);
  if (look_.glints && !look_.retro_reflective)
    AddGlints(posed_in_stage_mm, stage_from_head, filmed);
  Light(frame / take_.truth.rate_hz, filmed);
  return filmed;
}

// A sticker lies as the skin's smooth normal has it; lips and folds rise over it by up to a radius.
void FilmedSpeaker::AddDots(const std::vector<Eigen::Vector3d>& posed_in_stage_mm,
                            const std::vector<Eigen::Vector3d>& centers_mm,
                            SpeakerScene& filmed) const {
  const double radius_mm = look_.dot_diameter_mm / 2;
  const Eigen::Vector3f white = Eigen::Vector3f::Constant(0.85f);
  const Material material = {.gloss = 0, .glow = look_.retro_reflective ? 1.0f : 0.0f};
  const std::vector<Eigen::Vector3d> normals =
      VertexNormals({posed_in_stage_mm, speaker_.neutral_mesh().triangles});
  filmed.num_dots = static_cast<int>(centers_mm.size());
  for (int dot = 0; dot < filmed.num_dots; ++dot) {
    if (look_.dots != DotKind::kDisc) {
      filmed.scene.spheres.push_back({centers_mm[dot], radius_mm, white, material});
      continue;
    }
    const VirtualMarker& place = take_.true_attachments[dot];
    const Eigen::Vector3d normal = (1 - place.s - place.t) * normals[place.triangle[0]] +
                                   place.s * normals[place.triangle[1]] +
                                   place.t * normals[place.triangle[2]];
    filmed.scene.discs.push_back(
        {centers_mm[dot], normal.normalized(), radius_mm, radius_mm, white, material});
  }
}

// How sharp each shines is so that its image is some two millimetres wide: the rounder the place,
// the less.
void FilmedSpeaker::AddGlints(const std::vector<Eigen::Vector3d>& posed_in_stage_mm,
                              const Rigid3d& stage_from_head, SpeakerScene& filmed) const {
  struct Site {
    const char* landmark;
    Eigen::Vector3d beside_mm;  // head axes
    double radius_mm;
    float shininess;
  };
  const Site sites[] = {{"left_eye_center", {0, 0, 10}, 8, 250},
                        {"right_eye_center", {0, 0, 10}, 8, 250},
                        {"lower_lip_center", {0, 5, 0}, 10, 120},
                        {"nose_tip", {0, 0, 0}, 10, 250},
                        {"forehead_center", {0, 0, 0}, 28, 2000}};
  for (const Site& site : sites) {
    const auto vertex = speaker_.FindLandmark(site.landmark);
    if (!vertex) continue;
    const Eigen::Vector3d beside_mm = stage_from_head.rotation * site.beside_mm;
    filmed.scene.wet_spots.push_back({.center_mm = posed_in_stage_mm[*vertex] + beside_mm,
                                      .radius_mm = site.radius_mm,
                                      .shininess = site.shininess});
    filmed.glint_names.push_back(std::string("glint_") + site.landmark);
  }
}

void FilmedSpeaker::Light(double time_s, SpeakerScene& filmed) const {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  Scene& scene = filmed.scene;
  if (look_.retro_reflective) {
    scene.lights.clear();
    scene.ambient = Eigen::Vector3f::Constant(0.05f);
    scene.background = Eigen::Vector3f::Constant(0.03f);
  } else {
    // So that a white dot that faces the lamp nearly fills the range.
    constexpr float kLight = 1.05f;
    const auto diffuse = static_cast<float>(look_.diffuse_light);
    scene.lights = {{{0.35, 0.6, 1}, Eigen::Vector3f::Constant(kLight * (1 - diffuse)), 0}};
    scene.ambient = Eigen::Vector3f::Constant(kLight * diffuse);
    scene.background = Eigen::Vector3f::Constant(0.12f);
  }
  const auto change = static_cast<float>(
      1 + look_.light_drift * std::sin(kTurn_rad * time_s / look_.drift_period_s) +
      look_.light_flicker * std::cos(kTurn_rad * time_s * look_.flicker_hz));
  for (DirectionalLight& light : scene.lights) light.radiance *= change;
  scene.ambient *= change;
  scene.background *= change;
}

}  // namespace articap
