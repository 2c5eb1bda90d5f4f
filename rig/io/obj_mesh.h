// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh.h"
#include "core/result.h"

namespace articap {

// The geometry of a Wavefront OBJ file as it stands there: polygons, groups, no unit.
// (tinyobjloader rounds numbers in its own way and does not say where a file is wrong; rig folders
// need both exact numbers and line numbers, so this reader is ours.)
struct ObjMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3f> colors;   // of every vertex ("v x y z r g b"), or empty
  std::vector<std::string> group_names;  // texts behind "g" or "o"; "" before the first of them
  struct Face {
    int first_corner = 0;  // in corners
    int num_corners = 0;
    int group = 0;
  };
  std::vector<Face> faces;
  std::vector<int> corners;  // vertex indices from 0

  const int* face_corners(const Face& face) const { return &corners[face.first_corner]; }
};

// `source` names the file in messages. Texture coordinates, normals and materials are passed over.
Result<ObjMesh> ParseObj(std::string_view text, std::string_view source);

// Triangles of one polygon: quads are cut along the shorter diagonal (the same on both sides of a
// symmetric face), other polygons fan out from their first corner.
void AppendTriangles(const std::vector<Eigen::Vector3d>& vertices, const int* corners,
                     int num_corners, std::vector<Eigen::Vector3i>& triangles);

// One pose as an OBJ file: exact numbers, in mm.
std::string ObjText(const std::vector<Eigen::Vector3d>& vertices,
                    const std::vector<Eigen::Vector3i>& triangles,
                    const std::vector<Eigen::Vector3f>& colors,
                    const std::vector<std::string>& triangle_groups);

}  // namespace articap
