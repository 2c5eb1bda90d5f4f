// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/virtual_marker.h"
#include "rig/face_rig.h"

namespace articap {

// The region that most triangles around a vertex belong to; nothing for a vertex without triangles.
std::optional<int> RegionOfVertex(const FaceRig& rig, int vertex);

// Ties points to the surface of a rig in a pose, so that the virtual marker lies exactly on the
// point.
class Attacher {
 public:
  // `parameters`: the rig's pose. The rig must outlive the attacher.
  Attacher(const FaceRig& rig, const Eigen::VectorXd& parameters);

  // On the triangle of a region that lies nearest to the point; regions are what keeps a marker of
  // the upper lip from being tied to the lower one. Nothing where the region has no triangle of any
  // size.
  std::optional<VirtualMarker> AttachInRegion(const std::string& name, int region,
                                              const Eigen::Vector3d& point_in_rig) const;

  // On a triangle of a region around a vertex, for points whose place on the face is known better
  // than their distance to a rig of another shape tells.
  std::optional<VirtualMarker> AttachAtVertex(const std::string& name, int vertex, int region,
                                              const Eigen::Vector3d& point_in_rig) const;

  const std::vector<Eigen::Vector3d>& vertices_mm() const { return posed_.vertices; }
  // Distance of a point to the nearest triangle of a region, mm of the rig; infinite without
  // triangles.
  double DistanceToRegion(int region, const Eigen::Vector3d& point_in_rig) const;

 private:
  std::optional<VirtualMarker> Solve(const std::string& name, const Eigen::Vector3i& triangle,
                                     int first_corner, const Eigen::Vector3d& point_in_rig) const;
  template <class Accept>
  std::optional<VirtualMarker> AttachToNearest(const std::string& name,
                                               const Eigen::Vector3d& point_in_rig,
                                               Accept accept) const;

  const FaceRig& rig_;
  TriangleMesh posed_;
  std::vector<Eigen::Vector3d> normals_;
};

// The point of a triangle nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Eigen::Vector3d ClosestPointOfTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace articap
