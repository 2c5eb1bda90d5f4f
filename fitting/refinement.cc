// SPDX-License-Identifier: MIT
#include "fitting/refinement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace articap {
namespace {

// Scale of the distances below which a frame counts in full, mm.
constexpr double kInlier_mm = 1;

// Normal equations of one marker's (s, t, u).
struct StuEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();

  void Add(const Eigen::Matrix3d& basis, const Eigen::Vector3d& arm, double weight) {
    matrix += weight * basis.transpose() * basis;
    right += weight * basis.transpose() * arm;
  }
};

}  // namespace

std::vector<VirtualMarker> RefineAttachments(const FaceRig& rig,
                                             const std::vector<VirtualMarker>& markers,
                                             const RigTracks& measured, std::span<const int> frames,
                                             const Eigen::MatrixXd& poses, double prior_mm) {
  std::vector<StuEquations> equations(markers.size());
  TriangleMesh posed{{}, rig.neutral_mesh().triangles};
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Eigen::VectorXd pose = poses.row(frames[k]);
    if (!pose.allFinite()) continue;
    posed.vertices = rig.Evaluate(pose);
    const auto normals = VertexNormals(posed);
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const int marker = static_cast<int>(i);
      if (measured.is_missing(frames[k], marker)) continue;
      const Eigen::Vector3i& corners = markers[i].triangle;
      const Eigen::Vector3d& v1 = posed.vertices[corners[0]];
      Eigen::Matrix3d basis;
      basis << posed.vertices[corners[1]] - v1, posed.vertices[corners[2]] - v1,
          normals[corners[0]];
      const Eigen::Vector3d arm = measured.position_mm(frames[k], marker) - v1;
      const Eigen::Vector3d stu(markers[i].s, markers[i].t, markers[i].u_mm);
      equations[i].Add(basis, arm, 1 / std::max(kInlier_mm, (basis * stu - arm).norm()));
    }
  }

  std::vector<VirtualMarker> refined = markers;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    // The prior speaks in mm along the triangle's edges and normal of the neutral pose.
    const Eigen::Vector3i& corners = markers[i].triangle;
    const auto& neutral = rig.neutral_mesh().vertices;
    const Eigen::Vector3d stu(markers[i].s, markers[i].t, markers[i].u_mm);
    const Eigen::Vector3d lengths_mm((neutral[corners[1]] - neutral[corners[0]]).norm(),
                                     (neutral[corners[2]] - neutral[corners[0]]).norm(), 1);
    const Eigen::Vector3d weights = (lengths_mm / prior_mm).array().square();
    const Eigen::Matrix3d matrix = equations[i].matrix + Eigen::Matrix3d(weights.asDiagonal());
    const Eigen::Vector3d solution =
        matrix.ldlt().solve(equations[i].right + weights.cwiseProduct(stu));
    if (!solution.allFinite()) continue;
    refined[i].s = solution[0];
    refined[i].t = solution[1];
    refined[i].u_mm = solution[2];
  }
  return refined;
}

}  // namespace articap
