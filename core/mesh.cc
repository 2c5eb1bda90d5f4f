// SPDX-License-Identifier: MIT
#include "core/mesh.h"

#include <Eigen/Geometry>

namespace articap {

std::vector<Eigen::Vector3d> VertexNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const Eigen::Vector3d& v1 = mesh.vertices[triangle[0]];
    const Eigen::Vector3d& v2 = mesh.vertices[triangle[1]];
    const Eigen::Vector3d& v3 = mesh.vertices[triangle[2]];
    const Eigen::Vector3d area_normal = (v2 - v1).cross(v3 - v1);
    for (const int corner : {0, 1, 2}) normals[triangle[corner]] += area_normal;
  }
  for (Eigen::Vector3d& normal : normals) {
    const double length = normal.norm();
    if (length > 0) normal /= length;
  }
  return normals;
}

}  // namespace articap
