// SPDX-License-Identifier: MIT
#include "render/traced_scene.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>

#include "core/check.h"

namespace articap {
namespace {

using Eigen::Vector3f;

// Rays that leave a surface start this far off it, so that they do not meet it again.
constexpr float kLiftOff_mm = 0.02f;
// How far over its triangle the curved surface of smooth normals may rise.
constexpr float kMaxBulge_mm = 0.4f;
// Smooth normals further from the triangle's own than its angle are not used.
constexpr float kMinSmoothCosine = 0.2f;

void SetRay(RTCRay& ray, const Vector3f& origin_mm, const Vector3f& direction, float distance_mm) {
  ray.org_x = origin_mm.x();
  ray.org_y = origin_mm.y();
  ray.org_z = origin_mm.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = 0;
  ray.tfar = distance_mm;
  ray.mask = 0xFFFFFFFFu;
}

// The nearest thing along a ray, if it is nearer than `distance_mm`.
std::optional<RTCRayHit> NearestHit(RTCScene traced, const SightRay& ray, double distance_mm) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  SetRay(query.ray, ray.origin_mm.cast<float>(), ray.direction.cast<float>(),
         static_cast<float>(distance_mm));
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(traced, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return query;
}

// Whether a point of a disc shows where there is also another surface: it lies before that, or that
// gives way to it.
bool LiesOn(const RenderDisc& disc, const SurfacePoint& of_disc, const SurfacePoint& other,
            const SightRay& ray) {
  const Vector3f beyond_mm = other.position_mm - of_disc.position_mm;
  if (beyond_mm.dot(ray.direction.cast<float>()) >= 0) return true;
  const Eigen::Vector3d arm_mm = other.position_mm.cast<double>() - disc.center_mm;
  const double height_mm = arm_mm.dot(disc.normal);
  // A little more than what is beneath, since that is bent where a sticker ends.
  constexpr double kBeneath = 1.25;
  return height_mm <= disc.give_mm &&
         (arm_mm - height_mm * disc.normal).norm() <= kBeneath * disc.radius_mm;
}

}  // namespace

void TracedScene::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }

void TracedScene::Release::operator()(RTCSceneTy* traced) const { rtcReleaseScene(traced); }

TracedScene::TracedScene(const Scene& scene)
    : scene_(scene), device_(rtcNewDevice("threads=1")), traced_(rtcNewScene(device_.get())) {
  ARTICAP_CHECK(device_ != nullptr);
  rtcSetSceneFlags(traced_.get(), RTC_SCENE_FLAG_ROBUST);
  for (const RenderMesh& mesh : scene.meshes) AddMesh(mesh);
  AddSpheres(scene.spheres);
  rtcCommitScene(traced_.get());
  if (!scene.discs.empty()) AddDiscs(scene.discs);
  for (const RenderMirror& mirror : scene.mirrors) mirrors_.emplace_back(mirror);
}

SightEnd TracedScene::Follow(const SightRay& ray_of_sight) const {
  SightEnd end;
  for (SightRay ray = ray_of_sight;;) {
    std::optional<MirrorMeeting> meeting;
    int nearest = -1;
    for (std::size_t i = 0; i < mirrors_.size(); ++i) {
      const auto other = mirrors_[i].Meet(ray);
      if (!other || (meeting && meeting->distance_mm <= other->distance_mm)) continue;
      meeting = other;
      nearest = static_cast<int>(i);
    }
    end.direction = ray.direction.cast<float>();
    end.surface =
        FindSurface(ray, meeting ? meeting->distance_mm : std::numeric_limits<float>::infinity());
    if (end.surface) return end;
    end.color = meeting ? scene_.mirrors[nearest].frame_color : scene_.background;
    if (!meeting || !meeting->reflected || end.num_mirrors == SightEnd::kMostMirrors) return end;
    end.mirrors[end.num_mirrors++] = nearest;
    end.transmission *= scene_.mirrors[nearest].reflectance;
    ray = *meeting->reflected;
  }
}

std::optional<SurfacePoint> TracedScene::FindSurface(const SightRay& ray,
                                                     double distance_mm) const {
  const auto hit = NearestHit(traced_.get(), ray, distance_mm);
  std::optional<SurfacePoint> surface;
  if (hit) {
    surface.emplace();
    surface->position_mm =
        ray.origin_mm.cast<float>() + hit->ray.tfar * ray.direction.cast<float>();
    if (hit->hit.geomID < scene_.meshes.size())
      DescribeTriangle(hit->hit, ray.direction.cast<float>(), *surface);
    else
      DescribeSphere(hit->hit, *surface);
  }
  if (!traced_discs_) return surface;
  const auto disc = FindDisc(ray, distance_mm);
  return disc && (!surface || LiesOn(scene_.discs[disc->disc], *disc, *surface, ray)) ? disc
                                                                                      : surface;
}

std::optional<SurfacePoint> TracedScene::FindDisc(const SightRay& ray, double distance_mm) const {
  const auto hit = NearestHit(traced_discs_.get(), ray, distance_mm);
  if (!hit) return std::nullopt;
  const RenderDisc& disc = scene_.discs[hit->hit.primID];
  if (disc.normal.dot(ray.direction) >= 0) return std::nullopt;
  SurfacePoint surface;
  surface.position_mm = ray.origin_mm.cast<float>() + hit->ray.tfar * ray.direction.cast<float>();
  surface.normal = disc.normal.cast<float>();
  surface.start_mm =
      surface.position_mm + (static_cast<float>(disc.give_mm) + kLiftOff_mm) * surface.normal;
  surface.color = disc.color;
  surface.material = &disc.material;
  surface.disc = static_cast<int>(hit->hit.primID);
  return surface;
}

bool TracedScene::IsBlocked(const Vector3f& origin_mm, const Vector3f& direction,
                            float distance_mm) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  SetRay(ray, origin_mm, direction, distance_mm);
  rtcOccluded1(traced_.get(), &context, &ray);
  return ray.tfar < 0;
}

void TracedScene::Attach(RTCGeometryTy* geometry, std::size_t id, RTCSceneTy* traced) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(traced, geometry, static_cast<unsigned>(id));
  rtcReleaseGeometry(geometry);
}

void TracedScene::AddMesh(const RenderMesh& mesh) {
  const auto& [vertices, triangles] = mesh.mesh;
  ARTICAP_CHECK_EQ(mesh.colors.size(), vertices.size());
  std::vector<Vector3f>& normals = normals_.emplace_back();
  for (const Eigen::Vector3d& normal :
       mesh.normals.empty() ? VertexNormals(mesh.mesh) : mesh.normals)
    normals.push_back(normal.cast<float>());
  ARTICAP_CHECK_EQ(normals.size(), vertices.size());
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), std::max<std::size_t>(1, vertices.size())));
  for (const Eigen::Vector3d& vertex : vertices)
    for (int axis = 0; axis < 3; ++axis) *positions++ = static_cast<float>(vertex[axis]);
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), triangles.size()));
  for (const Eigen::Vector3i& triangle : triangles)
    for (const int corner : {triangle[0], triangle[1], triangle[2]})
      *corners++ = static_cast<std::uint32_t>(corner);
  Attach(geometry, normals_.size() - 1, traced_.get());
}

void TracedScene::AddSpheres(const std::vector<RenderSphere>& spheres) {
  if (spheres.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* values = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), spheres.size()));
  for (const RenderSphere& sphere : spheres) {
    for (int axis = 0; axis < 3; ++axis) *values++ = static_cast<float>(sphere.center_mm[axis]);
    *values++ = static_cast<float>(sphere.radius_mm);
  }
  Attach(geometry, scene_.meshes.size(), traced_.get());
}

void TracedScene::AddDiscs(const std::vector<RenderDisc>& discs) {
  traced_discs_.reset(rtcNewScene(device_.get()));
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
  auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), discs.size()));
  auto* normals = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), discs.size()));
  for (const RenderDisc& disc : discs) {
    for (int axis = 0; axis < 3; ++axis) *places++ = static_cast<float>(disc.center_mm[axis]);
    *places++ = static_cast<float>(disc.radius_mm);
    for (int axis = 0; axis < 3; ++axis) *normals++ = static_cast<float>(disc.normal[axis]);
  }
  Attach(geometry, 0, traced_discs_.get());
  rtcCommitScene(traced_discs_.get());
}

// Smooth normal and colour. Shadow rays start on the curved surface that the normals describe
// (Hanika, "Hacking the shadow terminator", 2021), else coarse triangles shadow themselves.
void TracedScene::DescribeTriangle(const RTCHit& hit, const Vector3f& direction,
                                   SurfacePoint& surface) const {
  const RenderMesh& mesh = scene_.meshes[hit.geomID];
  const Eigen::Vector3i& triangle = mesh.mesh.triangles[hit.primID];
  const float weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
  Vector3f facet_normal = Vector3f(hit.Ng_x, hit.Ng_y, hit.Ng_z).normalized();
  const float side = facet_normal.dot(direction) > 0 ? -1.0f : 1.0f;
  facet_normal *= side;
  Vector3f normal = Vector3f::Zero();
  Vector3f color = Vector3f::Zero();
  Vector3f bulge = Vector3f::Zero();
  for (const int corner : {0, 1, 2}) {
    const int vertex = triangle[corner];
    Vector3f corner_normal = side * normals_[hit.geomID][vertex];
    // Over sharp edges and folds a smooth normal says nothing about this triangle.
    if (corner_normal.dot(facet_normal) < kMinSmoothCosine) corner_normal = facet_normal;
    const Vector3f arm = surface.position_mm - mesh.mesh.vertices[vertex].cast<float>();
    bulge -= weights[corner] * std::min(0.0f, arm.dot(corner_normal)) * corner_normal;
    normal += weights[corner] * corner_normal;
    color += weights[corner] * mesh.colors[vertex];
  }
  surface.normal = normal.norm() > 0 ? normal.normalized() : facet_normal;
  // Seen from the front, a smooth normal must not point away from the viewer.
  const float away = surface.normal.dot(direction);
  if (away > 0) surface.normal = (surface.normal - 1.001f * away * direction).normalized();
  surface.color = color;
  surface.material = &mesh.material;
  // At sharp edges the curved surface is a fiction that reaches through thin walls.
  const float height_mm = bulge.norm();
  if (height_mm > kMaxBulge_mm) bulge *= kMaxBulge_mm / height_mm;
  surface.start_mm = surface.position_mm + bulge + kLiftOff_mm * facet_normal;
}

void TracedScene::DescribeSphere(const RTCHit& hit, SurfacePoint& surface) const {
  const RenderSphere& sphere = scene_.spheres[hit.primID];
  surface.normal = (surface.position_mm - sphere.center_mm.cast<float>()).normalized();
  surface.color = sphere.color;
  surface.material = &sphere.material;
  surface.sphere = static_cast<int>(hit.primID);
  surface.start_mm = surface.position_mm + kLiftOff_mm * surface.normal;
}

}  // namespace articap
