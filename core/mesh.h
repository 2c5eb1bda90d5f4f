// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

namespace articap {

// A triangle mesh in one frame, lengths in mm. Triangles wind counter-clockwise seen from outside,
// so that (v2 - v1) x (v3 - v1) points outwards.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

// Area-weighted unit normals, one a vertex: the normalised sum of the (unnormalised) cross products
// of the triangles around it. Zero where a vertex has no triangle or they cancel.
std::vector<Eigen::Vector3d> VertexNormals(const TriangleMesh& mesh);

}  // namespace articap
