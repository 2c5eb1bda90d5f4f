// SPDX-License-Identifier: MIT
#include "fitting/refinement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/attachment.h"

namespace articap {
namespace {

// Distance below which a frame counts in full, mm.
constexpr double kInlier_mm = 3;

// Standard deviation of (s, t) about the triangle's middle, in edges: keeps the foot of a marker
// near to its triangle where the frames do not tell.
constexpr double kEdgePrior = 2;

// The mesh in one of the frames.
struct PosedFrame {
  int frame = 0;
  std::vector<Eigen::Vector3d> vertices, normals;

  Eigen::Matrix3d Basis(const Eigen::Vector3i& corners) const {
    Eigen::Matrix3d basis;
    basis << vertices[corners[1]] - vertices[corners[0]],
        vertices[corners[2]] - vertices[corners[0]], normals[corners[0]];
    return basis;
  }
};

std::vector<PosedFrame> PoseFrames(const FaceRig& rig, std::span<const int> frames,
                                   const Eigen::MatrixXd& poses) {
  std::vector<PosedFrame> posed_frames;
  TriangleMesh posed{{}, rig.neutral_mesh().triangles};
  for (const int frame : frames) {
    const Eigen::VectorXd pose = poses.row(frame);
    if (!pose.allFinite()) continue;
    posed.vertices = rig.Evaluate(pose);
    auto normals = VertexNormals(posed);
    posed_frames.push_back({frame, posed.vertices, std::move(normals)});
  }
  return posed_frames;
}

// One marker as seen in the frames, with the weight that each frame deserves.
struct Sighting {
  const PosedFrame* posed = nullptr;
  Eigen::Vector3d point_in_rig = Eigen::Vector3d::Zero();
  double weight = 1;
};

std::vector<Sighting> SightingsOf(int marker, const VirtualMarker& current,
                                  const RigTracks& measured,
                                  const std::vector<PosedFrame>& posed_frames) {
  std::vector<Sighting> sightings;
  const Eigen::Vector3d stu(current.s, current.t, current.u_mm);
  for (const PosedFrame& posed : posed_frames) {
    if (measured.is_missing(posed.frame, marker)) continue;
    const Eigen::Vector3d& point = measured.position_mm(posed.frame, marker);
    const Eigen::Vector3d predicted =
        posed.vertices[current.triangle[0]] + posed.Basis(current.triangle) * stu;
    sightings.push_back({&posed, point, 1 / std::max(kInlier_mm, (predicted - point).norm())});
  }
  return sightings;
}

struct Candidate {
  VirtualMarker marker;
  double cost = std::numeric_limits<double>::infinity();
};

// The best (s, t, u) on one triangle, and what it costs.
Candidate SolveOnTriangle(const std::string& name, const Eigen::Vector3i& corners,
                          const std::vector<Sighting>& sightings) {
  // The prior: (s, t) about the middle of the triangle.
  const double prior = 1 / (kEdgePrior * kEdgePrior);
  Eigen::Matrix3d matrix = Eigen::Vector3d(prior, prior, 1e-9).asDiagonal();
  Eigen::Vector3d right(prior / 3, prior / 3, 0);
  double constant = 2 * prior / 9;
  for (const Sighting& sighting : sightings) {
    const Eigen::Matrix3d basis = sighting.posed->Basis(corners);
    const Eigen::Vector3d arm = sighting.point_in_rig - sighting.posed->vertices[corners[0]];
    matrix += sighting.weight * basis.transpose() * basis;
    right += sighting.weight * basis.transpose() * arm;
    constant += sighting.weight * arm.squaredNorm();
  }
  const Eigen::Vector3d stu = matrix.ldlt().solve(right);
  if (!stu.allFinite()) return {};
  return {{name, corners, stu[0], stu[1], stu[2]}, constant - right.dot(stu)};
}

// Triangles of the region around the foot of a bound marker, first the one that it was bound to.
std::vector<Eigen::Vector3i> TrianglesInReach(const FaceRig& rig, const VirtualMarker& bound,
                                              double reach_mm) {
  std::vector<Eigen::Vector3i> triangles = {bound.triangle};
  const TriangleMesh& mesh = rig.neutral_mesh();
  const auto center = [&](const Eigen::Vector3i& corners) -> Eigen::Vector3d {
    return (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]) / 3;
  };
  const auto region = RegionOfTriangle(rig, bound.triangle);
  const Eigen::Vector3d foot = center(bound.triangle);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (rig.definition().triangle_region[i] == region &&
        (center(mesh.triangles[i]) - foot).norm() <= reach_mm)
      triangles.push_back(mesh.triangles[i]);
  return triangles;
}

}  // namespace

std::vector<VirtualMarker> RefineAttachments(const FaceRig& rig,
                                             const std::vector<VirtualMarker>& bound,
                                             const std::vector<VirtualMarker>& current,
                                             const RigTracks& measured, std::span<const int> frames,
                                             const Eigen::MatrixXd& poses, double reach_mm) {
  const std::vector<PosedFrame> posed_frames = PoseFrames(rig, frames, poses);
  std::vector<VirtualMarker> refined = current;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    const auto sightings = SightingsOf(static_cast<int>(i), current[i], measured, posed_frames);
    if (sightings.empty()) continue;
    Candidate best;
    for (const Eigen::Vector3i& corners : TrianglesInReach(rig, bound[i], reach_mm)) {
      Candidate candidate = SolveOnTriangle(bound[i].name, corners, sightings);
      if (candidate.cost < best.cost) best = std::move(candidate);
    }
    if (std::isfinite(best.cost)) refined[i] = std::move(best.marker);
  }
  return refined;
}

}  // namespace articap
