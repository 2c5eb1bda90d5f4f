// SPDX-License-Identifier: MIT
#include "tests/support/face_dots.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/rig_view.h"
#include "render/traced_scene.h"
#include "rig/default_head/default_head.h"
#include "rig/virtual_marker_evaluator.h"
#include "synthetic/random.h"
#include "synthetic/sensor.h"
#include "synthetic/speaker.h"
#include "tests/support/test_data.h"

namespace articap {
namespace {

// How far a disc lies above the triangle that it is glued to, so that bent skin does not pierce it.
constexpr double kLift_mm = 0.4;

struct Disc {
  Eigen::Vector3d center_mm;
  Eigen::Vector3d normal;
};

// Points around the middle, on the disc.
std::vector<Eigen::Vector3d> RimOf(const Disc& disc, double radius_mm, int count) {
  const Eigen::Vector3d u = disc.normal.unitOrthogonal(), v = disc.normal.cross(u);
  std::vector<Eigen::Vector3d> rim;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    rim.emplace_back(disc.center_mm + radius_mm * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return rim;
}

RenderMesh MeshOf(const Disc& disc, double radius_mm) {
  constexpr int kCorners = 48;
  RenderMesh mesh;
  mesh.mesh.vertices = RimOf(disc, radius_mm, kCorners);
  mesh.mesh.vertices.push_back(disc.center_mm);
  for (int i = 0; i < kCorners; ++i)
    mesh.mesh.triangles.emplace_back(kCorners, i, (i + 1) % kCorners);
  mesh.colors.assign(mesh.mesh.vertices.size(), Eigen::Vector3f::Constant(0.9f));
  mesh.material = MaterialOfPart("markers");
  return mesh;
}

std::vector<Disc> DiscsOf(const FaceRig& rig, const std::vector<VirtualMarker>& markers,
                          const Eigen::VectorXd& parameters) {
  const std::vector<Eigen::Vector3d> posed = rig.Evaluate(parameters);
  const Eigen::Matrix3Xd positions =
      VirtualMarkerEvaluator(rig, markers)
          .Positions({parameters.data(), static_cast<std::size_t>(parameters.size())});
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const Eigen::Vector3i& triangle = markers[i].triangle;
    const Eigen::Vector3d normal = (posed[triangle[1]] - posed[triangle[0]])
                                       .cross(posed[triangle[2]] - posed[triangle[0]])
                                       .normalized();
    discs.push_back({positions.col(static_cast<Eigen::Index>(i)) + kLift_mm * normal, normal});
  }
  return discs;
}

// How many of the points nothing lies before.
int CountVisible(const TracedScene& traced, const PinholeView& camera,
                 const std::vector<Eigen::Vector3d>& points) {
  int count = 0;
  for (const Eigen::Vector3d& point : points) {
    const auto ray = camera.RayThrough(camera.Project(point));
    if (!ray) continue;
    const SightEnd end = traced.Follow(*ray);
    count += end.surface && (end.surface->position_mm.cast<double>() - point).norm() < 0.2;
  }
  return count;
}

}  // namespace

std::vector<FaceDotPicture> RenderFaceDots(const FaceDotOptions& options) {
  const MarkerSet set = ReadMarkerSet(SourceFolder() / "maps" / "spectacles30.toml").value();
  SyntheticTakeOptions take_options;
  take_options.seed = options.seed;
  take_options.speech.num_sentences = 2;
  take_options.identity_spread = 0;
  const FaceRig rig = MakeDefaultHead().value();
  const SyntheticTake take = SynthesizeTake(rig, set, take_options).value();
  std::vector<VirtualMarker> on_skin, on_spectacles;
  for (const VirtualMarker& marker : take.true_attachments)
    (set.Find(marker.name)->face ? on_skin : on_spectacles).push_back(marker);
  RandomGenerator random(static_cast<std::uint64_t>(options.seed), 300);
  std::vector<FaceDotPicture> pictures;
  for (int i = 0; i < options.pictures; ++i) {
    const Eigen::VectorXd parameters =
        take.truth.values.row(take.truth.values.rows() * (2 * i + 1) / (2 * options.pictures));
    Scene scene = SceneOf(rig, parameters);
    const double radius_mm = options.dot_diameter_mm / 2;
    const std::vector<Disc> discs = DiscsOf(rig, on_skin, parameters);
    for (const Disc& disc : discs) scene.meshes.push_back(MeshOf(disc, radius_mm));
    const double largest_rad = 25 * std::numbers::pi / 180;
    const PinholeView camera =
        HeadCamera(rig, random.Uniform(-largest_rad, largest_rad), random.Uniform(-0.15, 0.15),
                   options.width, options.height);
    const LinearPicture light =
        RenderLinear(scene, camera, {.samples_per_side = 4, .one_sample_below = 0.01});
    FaceDotPicture picture;
    picture.image = Expose(light, {}, static_cast<std::uint64_t>(options.seed * 1000 + i));
    const TracedScene traced(scene);
    for (const Disc& disc : discs) {
      std::vector<Eigen::Vector3d> points = RimOf(disc, 0.9 * radius_mm, 16);
      points.push_back(disc.center_mm);
      const int visible = CountVisible(traced, camera, points);
      if (visible == 0) continue;
      const Eigen::Vector2d middle = camera.Project(disc.center_mm);
      const double facing = -camera.RayThrough(middle)->direction.dot(disc.normal);
      const bool is_clear = visible == static_cast<int>(points.size()) && facing >= 0.5;
      (is_clear ? picture.clear : picture.doubtful).push_back(middle);
    }
    for (const Disc& stud : DiscsOf(rig, on_spectacles, parameters))
      picture.studs.push_back(camera.Project(stud.center_mm));
    pictures.push_back(std::move(picture));
  }
  return pictures;
}

void DotScore::Add(const FaceDotPicture& picture, const std::vector<Eigen::Vector2d>& points) {
  constexpr double kSame_px = 4, kSameStud_px = 9;
  std::vector<bool> taken(points.size());
  const auto take_near = [&](const Eigen::Vector2d& middle, double within_px) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!taken[i] && (points[i] - middle).norm() <= within_px) {
        taken[i] = true;
        return true;
      }
    return false;
  };
  clear += static_cast<int>(picture.clear.size());
  for (const Eigen::Vector2d& middle : picture.clear) found += take_near(middle, kSame_px);
  for (const Eigen::Vector2d& middle : picture.doubtful) take_near(middle, kSame_px);
  for (const Eigen::Vector2d& middle : picture.studs) take_near(middle, kSameStud_px);
  wrong += static_cast<int>(std::count(taken.begin(), taken.end(), false));
}

std::vector<Eigen::Vector2d> CentersOf(const std::vector<Dot>& dots) {
  std::vector<Eigen::Vector2d> centers;
  for (const Dot& dot : dots) centers.push_back(dot.center_px);
  return centers;
}

}  // namespace articap
