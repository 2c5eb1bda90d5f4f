// SPDX-License-Identifier: MIT
#include "render/rig_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace articap {
namespace {

// A portrait distance: near enough for perspective, far enough not to swell the nose.
constexpr double kDistance_mm = 1200;
// The head fills this part of the picture's height or width.
constexpr double kFilled = 0.88;

// One part's triangles with a vertex list of their own, so that normals stop at its border.
RenderMesh MeshOfPart(const RigDefinition& rig, const std::vector<Eigen::Vector3d>& posed,
                      std::size_t part) {
  RenderMesh mesh;
  mesh.material = MaterialOfPart(rig.part_names[part]);
  std::vector<int> new_index(posed.size(), -1);
  for (std::size_t i = 0; i < rig.mesh.triangles.size(); ++i) {
    if (rig.triangle_part[i] != part) continue;
    Eigen::Vector3i triangle = rig.mesh.triangles[i];
    for (int& corner : triangle) {
      int& index = new_index[corner];
      if (index < 0) {
        index = static_cast<int>(mesh.mesh.vertices.size());
        mesh.mesh.vertices.push_back(posed[corner]);
        mesh.colors.push_back(rig.colors[corner]);
      }
      corner = index;
    }
    mesh.mesh.triangles.push_back(triangle);
  }
  return mesh;
}

LookAt Orbit(const Eigen::Vector3d& target_mm, double yaw_rad, double pitch_rad) {
  const Eigen::Vector3d towards_eye(std::sin(yaw_rad) * std::cos(pitch_rad), std::sin(pitch_rad),
                                    std::cos(yaw_rad) * std::cos(pitch_rad));
  return {target_mm + kDistance_mm * towards_eye, target_mm, Eigen::Vector3d::UnitY()};
}

// Height that the picture must show so that a box of this size fits from any side.
double HeightToShow(double box_width_mm, double box_height_mm, int width, int height) {
  return std::max(box_height_mm, box_width_mm * height / width) / kFilled;
}

}  // namespace

Material MaterialOfPart(std::string_view part_name) {
  if (part_name == "teeth") return {0.7f, 60.0f, 0.2f, 0.0f};
  if (part_name == "tongue") return {0.5f, 40.0f, 0.8f, 0.0f};
  if (part_name.starts_with("eyes")) return {1.0f, 250.0f, 0.0f, 0.0f};
  if (part_name == "spectacles") return {0.6f, 80.0f, 0.0f, 0.0f};
  if (part_name == "hair" || part_name == "brows" || part_name == "lashes")
    return {0.1f, 12.0f, 0.0f, 0.0f};
  if (part_name == "markers") return {0.3f, 30.0f, 0.0f, 0.2f};
  return {0.35f, 14.0f, 1.0f, 0.0f};
}

Scene SceneOf(const FaceRig& rig, const Eigen::VectorXd& parameters,
              const RigViewOptions& options) {
  return SceneOf(rig, rig.Evaluate(parameters), options);
}

Scene SceneOf(const FaceRig& rig, const std::vector<Eigen::Vector3d>& posed_mm,
              const RigViewOptions& options) {
  const RigDefinition& definition = rig.definition();
  Scene scene;
  for (std::size_t part = 0; part < definition.part_names.size(); ++part) {
    if (definition.part_names[part] == "spectacles" && !options.show_spectacles) continue;
    RenderMesh mesh = MeshOfPart(definition, posed_mm, part);
    if (!mesh.mesh.triangles.empty()) scene.meshes.push_back(std::move(mesh));
  }
  scene.spheres = options.markers;
  if (options.show_landmarks)
    for (const Landmark& landmark : definition.landmarks)
      scene.spheres.push_back({posed_mm[landmark.vertex],
                               options.landmark_radius_mm,
                               {0.8f, 0.03f, 0.02f},
                               {0.2f, 30.0f, 0.0f, 0.3f}});
  return scene;
}

PinholeView HeadCamera(const FaceRig& rig, FaceView view, int width, int height) {
  switch (view) {
    case FaceView::kFront:
      return HeadCamera(rig, 0, 0, width, height);
    case FaceView::kThreeQuarter:
      return HeadCamera(rig, std::numbers::pi / 4, 0.08, width, height);
    case FaceView::kSide:
      break;
  }
  return HeadCamera(rig, std::numbers::pi / 2, 0, width, height);
}

PinholeView HeadCamera(const FaceRig& rig, double yaw_rad, double pitch_rad, int width,
                       int height) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3i& triangle : rig.neutral_mesh().triangles)
    for (const int corner : {triangle[0], triangle[1], triangle[2]}) {
      low = low.cwiseMin(rig.neutral_mesh().vertices[corner]);
      high = high.cwiseMax(rig.neutral_mesh().vertices[corner]);
    }
  const Eigen::Vector3d size = high - low;
  return PinholeView(Orbit(0.5 * (low + high), yaw_rad, pitch_rad),
                     HeightToShow(std::max(size.x(), size.z()), size.y(), width, height), width,
                     height);
}

PinholeView MouthCamera(const FaceRig& rig, double yaw_rad, double pitch_rad, int width,
                        int height) {
  const auto nose = rig.FindLandmark("nose_tip");
  const auto menton = rig.FindLandmark("menton");
  if (!nose || !menton) return HeadCamera(rig, yaw_rad, pitch_rad, width, height);
  const Eigen::Vector3d& top = rig.neutral_mesh().vertices[*nose];
  const Eigen::Vector3d& bottom = rig.neutral_mesh().vertices[*menton];
  const double length_mm = (top - bottom).norm();
  // Room below the chin for the jaw to open.
  const Eigen::Vector3d target_mm(0, 0.5 * (top.y() + bottom.y()) - 0.15 * length_mm,
                                  0.5 * (top.z() + bottom.z()) - 0.2 * length_mm);
  return PinholeView(Orbit(target_mm, yaw_rad, pitch_rad),
                     HeightToShow(1.4 * length_mm, 1.5 * length_mm, width, height), width, height);
}

}  // namespace articap
