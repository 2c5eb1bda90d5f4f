// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <limits>

#include "core/mesh.h"
#include "render/traced_scene.h"
#include "synthetic/speaker_scene.h"

namespace articap {
namespace {

using Eigen::Vector3f;

// Points of the meshes are tried this finely: each edge of a triangle in so many parts.
constexpr int kParts = 12;
// Fainter ones are lost in the skin's own light.
constexpr float kFaint = 0.3f;
// How far the brightest point that was tried may be from the surface that is seen there.
constexpr double kSamePlace_mm = 0.5;

// The brightest point of a wet spot, as an eye sees it.
struct Brightest {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  float shine = 0;
};

// The meshes near a wet spot, with their smooth normals.
class WetSkin {
 public:
  WetSkin(const Scene& scene, const std::vector<std::vector<Eigen::Vector3d>>& normals,
          const RenderWetSpot& spot)
      : spot_(spot), towards_lamp_(scene.lights.front().towards_light.normalized()) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
      const TriangleMesh& mesh = scene.meshes[i].mesh;
      for (const Eigen::Vector3i& triangle : mesh.triangles) {
        Corners corners;
        bool is_near = false;
        for (const int corner : {0, 1, 2}) {
          corners.points_mm.col(corner) = mesh.vertices[triangle[corner]];
          corners.normals.col(corner) = normals[i][triangle[corner]];
          is_near =
              is_near || (mesh.vertices[triangle[corner]] - spot.center_mm).norm() < spot.radius_mm;
        }
        if (is_near) triangles_.push_back(corners);
      }
    }
  }

  Brightest SeenFrom(const Eigen::Vector3d& eye_mm) const {
    Brightest best;
    for (const Corners& corners : triangles_)
      for (int i = 0; i <= kParts; ++i)
        for (int j = 0; i + j <= kParts; ++j)
          Try(corners, Eigen::Vector3d(kParts - i - j, i, j) / kParts, eye_mm, best);
    return best;
  }

 private:
  struct Corners {
    Eigen::Matrix3d points_mm, normals;  // a column each
  };

  void Try(const Corners& corners, const Eigen::Vector3d& weights, const Eigen::Vector3d& eye_mm,
           Brightest& best) const {
    const Eigen::Vector3d point_mm = corners.points_mm * weights;
    const Eigen::Vector3d normal = (corners.normals * weights).normalized();
    const Eigen::Vector3d towards_eye = (eye_mm - point_mm).normalized();
    if (normal.dot(towards_eye) <= 0 || normal.dot(towards_lamp_) <= 0) return;
    const Eigen::Vector3d halfway = (towards_lamp_ + towards_eye).normalized();
    const float shine =
        spot_.ShineAt(point_mm.cast<float>(), normal.cast<float>(), halfway.cast<float>());
    if (shine > best.shine) best = {point_mm, shine};
  }

  const RenderWetSpot& spot_;
  Eigen::Vector3d towards_lamp_;
  std::vector<Corners> triangles_;
};

// Whether what a view shows at a point is this point of a mesh, in the lamp's light.
bool IsSeen(const Studio& studio, const TracedScene& traced, const Scene& scene, const View& view,
            const Eigen::Vector3d& point_mm, const Eigen::Vector2d& point_px) {
  if (!IsInPicture(studio.cameras().array.cameras[view.camera], point_px)) return false;
  const auto ray = studio.lens_view(view.camera).RayThrough(point_px);
  if (!ray) return false;
  const SightEnd end = traced.Follow(*ray);
  return end.surface && end.IsBy(view.mirror) && end.surface->disc < 0 && end.surface->sphere < 0 &&
         (end.surface->position_mm.cast<double>() - point_mm).norm() < kSamePlace_mm &&
         !traced.IsBlocked(end.surface->start_mm,
                           scene.lights.front().towards_light.normalized().cast<float>());
}

}  // namespace

std::vector<std::vector<DotTruth>> TruthOfGlints(const Studio& studio, const SpeakerScene& filmed) {
  const CameraArray& array = studio.cameras().array;
  const Scene& scene = filmed.scene;
  const std::vector<View> views = array.views();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<DotTruth>> of_views(views.size());
  if (scene.wet_spots.empty()) return of_views;
  const TracedScene traced(scene);
  std::vector<std::vector<Eigen::Vector3d>> normals;
  for (const RenderMesh& mesh : scene.meshes) normals.push_back(VertexNormals(mesh.mesh));
  for (const RenderWetSpot& spot : scene.wet_spots) {
    const WetSkin skin(scene, normals, spot);
    for (std::size_t i = 0; i < views.size(); ++i) {
      DotTruth& truth =
          of_views[i].emplace_back(DotTruth{Eigen::Vector2d::Constant(unknown), 0, unknown});
      const Brightest brightest = skin.SeenFrom(EyeOf(array, views[i]));
      if (brightest.shine < kFaint) continue;
      const auto point_px = Project(array, views[i], brightest.point_mm);
      if (!point_px) continue;
      truth.center_px = *point_px;
      truth.visible =
          IsSeen(studio, traced, scene, views[i], brightest.point_mm, *point_px) ? 1 : 0;
    }
  }
  return of_views;
}

}  // namespace articap
