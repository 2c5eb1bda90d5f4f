// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "render/mirror_plane.h"
#include "render/scene.h"
#include "render/view_camera.h"

// Embree's own names of its objects.
struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;
struct RTCHit;

namespace articap {

// A point of a surface that a ray of sight has found.
struct SurfacePoint {
  Eigen::Vector3f position_mm;
  Eigen::Vector3f start_mm;  // where shadow rays start
  Eigen::Vector3f normal;    // smooth, unit, towards the viewer
  Eigen::Vector3f color;
  const Material* material = nullptr;
  // Index of the scene's disc or sphere that this is of; -1: of none.
  int disc = -1;
  int sphere = -1;
};

// Where a ray of sight ends, by way of mirrors.
struct SightEnd {
  std::optional<SurfacePoint> surface;
  // What shows where there is no surface: the background, or a mirror's frame. Linear RGB.
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();  // of the last stretch
  float transmission = 1;                                // what the mirrors on the way leave
  // Indices of the mirrors on the way, in their order; as many as there are.
  static constexpr int kMostMirrors = 8;
  int num_mirrors = 0;
  int mirrors[kMostMirrors] = {};

  // Whether the way leads by this mirror and no other; -1: by none.
  bool IsBy(int mirror) const {
    return mirror < 0 ? num_mirrors == 0 : num_mirrors == 1 && mirrors[0] == mirror;
  }
};

// A scene made ready for rays. The scene must outlive it. Surfaces are kept in float32: at 1 m a
// step of 0.0001 mm; mirrors in float64.
class TracedScene {
 public:
  explicit TracedScene(const Scene& scene);

  SightEnd Follow(const SightRay& ray) const;
  // Whether a surface, not a mirror, lies within the distance.
  bool IsBlocked(const Eigen::Vector3f& origin_mm, const Eigen::Vector3f& direction,
                 float distance_mm = std::numeric_limits<float>::infinity()) const;

 private:
  struct Release {
    void operator()(RTCDeviceTy* device) const;
    void operator()(RTCSceneTy* traced) const;
  };

  static void Attach(RTCGeometryTy* geometry, std::size_t id, RTCSceneTy* traced);
  void AddMesh(const RenderMesh& mesh);
  void AddSpheres(const std::vector<RenderSphere>& spheres);
  void AddDiscs(const std::vector<RenderDisc>& discs);
  // The nearest surface along a ray, if it is nearer than `distance_mm`.
  std::optional<SurfacePoint> FindSurface(const SightRay& ray, double distance_mm) const;
  void DescribeTriangle(const RTCHit& hit, const Eigen::Vector3f& direction,
                        SurfacePoint& surface) const;
  void DescribeSphere(const RTCHit& hit, SurfacePoint& surface) const;
  // The nearest disc along a ray, if it shows its front.
  std::optional<SurfacePoint> FindDisc(const SightRay& ray, double distance_mm) const;

  const Scene& scene_;
  std::vector<std::vector<Eigen::Vector3f>> normals_;
  std::vector<MirrorPlane> mirrors_;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> traced_;
  std::unique_ptr<RTCSceneTy, Release> traced_discs_;  // null where there are none
};

}  // namespace articap
