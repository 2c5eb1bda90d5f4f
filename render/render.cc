// SPDX-License-Identifier: MIT
#include "render/render.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <thread>

#include "core/check.h"

namespace articap {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Rays that leave a surface start this far off it, so that they do not meet it again.
constexpr float kLiftOff_mm = 0.02f;

// A point of a surface that a ray of sight has found.
struct SurfacePoint {
  Vector3f position_mm;
  Vector3f start_mm;  // where shadow rays start
  Vector3f normal;    // smooth, unit, towards the viewer
  Vector3f color;
  const Material* material = nullptr;
};

// Evenly spread numbers in [0, 1)^2 from an index: the R2 sequence of Roberts (2018), shifted by a
// hash of the pixel so that neighbouring pixels do not share a pattern.
class SampleSequence {
 public:
  SampleSequence(int x, int y) {
    std::uint32_t hash = static_cast<std::uint32_t>(x) * 0x9E3779B1u ^
                         (static_cast<std::uint32_t>(y) * 0x85EBCA77u + 0x27D4EB2Fu);
    for (float& shift : shift_) {
      hash = (hash ^ (hash >> 15)) * 0x2C1B3C6Du;
      hash = (hash ^ (hash >> 12)) * 0x297A2D39u;
      hash ^= hash >> 15;
      shift = static_cast<float>(hash >> 8) * 0x1p-24f;
    }
  }

  Vector2f Sample(int index, int dimension) const {
    const double x = shift_[(2 * dimension) % kNumShifts] + 0.7548776662466927 * index;
    const double y = shift_[(2 * dimension + 1) % kNumShifts] + 0.5698402909980532 * index;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
  }

 private:
  static constexpr int kNumShifts = 16;
  float shift_[kNumShifts];
};

// Two unit vectors that complete a unit vector to a frame (Duff et al. 2017).
void Complete(const Vector3f& axis, Vector3f& first, Vector3f& second) {
  const float sign = std::copysign(1.0f, axis.z());
  const float a = -1 / (sign + axis.z());
  const float b = axis.x() * axis.y() * a;
  first = Vector3f(1 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x());
  second = Vector3f(b, sign + axis.y() * axis.y() * a, -axis.y());
}

// The scene in Embree's hands. Coordinates are float32: at 1 m a step of 0.0001 mm.
class TracedScene {
 public:
  explicit TracedScene(const Scene& scene)
      : scene_(scene), device_(rtcNewDevice("threads=1")), traced_(rtcNewScene(device_.get())) {
    ARTICAP_CHECK(device_ != nullptr);
    rtcSetSceneFlags(traced_.get(), RTC_SCENE_FLAG_ROBUST);
    for (const RenderMesh& mesh : scene.meshes) AddMesh(mesh);
    AddSpheres(scene.spheres);
    rtcCommitScene(traced_.get());
  }

  // Nearest surface along a ray; false where there is none.
  bool FindSurface(const Vector3f& origin_mm, const Vector3f& direction,
                   SurfacePoint& surface) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    SetRay(query.ray, origin_mm, direction, kInfinity);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(traced_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    surface.position_mm = origin_mm + query.ray.tfar * direction;
    if (query.hit.geomID < scene_.meshes.size())
      DescribeTriangle(query.hit, direction, surface);
    else
      DescribeSphere(query.hit, surface);
    return true;
  }

  bool IsBlocked(const Vector3f& origin_mm, const Vector3f& direction, float distance_mm) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    SetRay(ray, origin_mm, direction, distance_mm);
    rtcOccluded1(traced_.get(), &context, &ray);
    return ray.tfar < 0;
  }

 private:
  struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  struct ReleaseScene {
    void operator()(RTCScene traced) const { rtcReleaseScene(traced); }
  };

  static void SetRay(RTCRay& ray, const Vector3f& origin_mm, const Vector3f& direction,
                     float distance_mm) {
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

  void Attach(RTCGeometry geometry, std::size_t id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(traced_.get(), geometry, static_cast<unsigned>(id));
    rtcReleaseGeometry(geometry);
  }

  void AddMesh(const RenderMesh& mesh) {
    const auto& [vertices, triangles] = mesh.mesh;
    ARTICAP_CHECK_EQ(mesh.colors.size(), vertices.size());
    normals_.push_back(mesh.normals.empty() ? VertexNormals(mesh.mesh) : mesh.normals);
    ARTICAP_CHECK_EQ(normals_.back().size(), vertices.size());
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
    Attach(geometry, normals_.size() - 1);
  }

  void AddSpheres(const std::vector<RenderSphere>& spheres) {
    if (spheres.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* values = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), spheres.size()));
    for (const RenderSphere& sphere : spheres) {
      for (int axis = 0; axis < 3; ++axis) *values++ = static_cast<float>(sphere.center_mm[axis]);
      *values++ = static_cast<float>(sphere.radius_mm);
    }
    Attach(geometry, scene_.meshes.size());
  }

  // Smooth normal and colour. Shadow rays start on the curved surface that the normals describe
  // (Hanika, "Hacking the shadow terminator", 2021), else coarse triangles shadow themselves.
  void DescribeTriangle(const RTCHit& hit, const Vector3f& direction, SurfacePoint& surface) const {
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
      const Vector3f corner_normal = side * normals_[hit.geomID][vertex].cast<float>();
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
    surface.start_mm = surface.position_mm + bulge + kLiftOff_mm * facet_normal;
  }

  void DescribeSphere(const RTCHit& hit, SurfacePoint& surface) const {
    const RenderSphere& sphere = scene_.spheres[hit.primID];
    surface.normal = (surface.position_mm - sphere.center_mm.cast<float>()).normalized();
    surface.color = sphere.color;
    surface.material = &sphere.material;
    surface.start_mm = surface.position_mm + kLiftOff_mm * surface.normal;
  }

  const Scene& scene_;
  std::vector<std::vector<Eigen::Vector3d>> normals_;
  std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
  std::unique_ptr<RTCSceneTy, ReleaseScene> traced_;
};

class Shader {
 public:
  Shader(const Scene& scene, const RenderOptions& options)
      : scene_(scene), options_(options), traced_(scene) {}

  // Light that comes back along a ray of sight. index: which of the pixel's samples this is.
  Vector3f Light(const SightRay& ray, const SampleSequence& sequence, int index) const {
    const Vector3f direction = ray.direction.cast<float>();
    SurfacePoint surface;
    if (!traced_.FindSurface(ray.origin_mm.cast<float>(), direction, surface))
      return scene_.background;
    Vector3f diffuse = surface.material->glow * Vector3f::Ones();
    diffuse += AmbientLight(surface, sequence.Sample(index, 0));
    Vector3f highlight = Vector3f::Zero();
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
      AddLamp(scene_.lights[i], surface, direction, sequence.Sample(index, 1 + static_cast<int>(i)),
              diffuse, highlight);
    return diffuse.cwiseProduct(surface.color) + highlight;
  }

 private:
  // One cosine-weighted ray decides whether the sample sees the sky. Some light always comes back
  // from the skin around a fold, and more of it red.
  Vector3f AmbientLight(const SurfacePoint& surface, const Vector2f& random) const {
    if (options_.occlusion_mm <= 0) return scene_.ambient;
    const float angle = 2 * std::numbers::pi_v<float> * random.x();
    Vector3f first, second;
    Complete(surface.normal, first, second);
    const float radius = std::sqrt(random.y());
    const Vector3f towards = radius * (std::cos(angle) * first + std::sin(angle) * second) +
                             std::sqrt(std::max(0.0f, 1 - random.y())) * surface.normal;
    if (!traced_.IsBlocked(surface.start_mm, towards, static_cast<float>(options_.occlusion_mm)))
      return scene_.ambient;
    return surface.material->translucence *
           scene_.ambient.cwiseProduct(Vector3f(0.35f, 0.2f, 0.16f));
  }

  void AddLamp(const DirectionalLight& light, const SurfacePoint& surface,
               const Vector3f& direction, const Vector2f& random, Vector3f& diffuse,
               Vector3f& highlight) const {
    const Vector3f axis = light.towards_light.normalized().cast<float>();
    Vector3f first, second;
    Complete(axis, first, second);
    const float radius =
        std::sqrt(random.x()) * static_cast<float>(std::tan(light.angular_radius_rad));
    const float angle = 2 * std::numbers::pi_v<float> * random.y();
    const Vector3f towards =
        (axis + radius * (std::cos(angle) * first + std::sin(angle) * second)).normalized();
    const float cosine = surface.normal.dot(towards);
    // Wrapped Lambert: how far light reaches beyond the terminator, per channel.
    const Vector3f wrap = surface.material->translucence * Vector3f(0.35f, 0.16f, 0.10f);
    const Vector3f lambert =
        ((Vector3f::Constant(cosine) + wrap).array() / (1 + wrap.array()).square())
            .max(0.0f)
            .matrix();
    if (lambert.x() <= 0) return;
    if (options_.shadows && traced_.IsBlocked(surface.start_mm, towards, kInfinity)) return;
    diffuse += light.radiance.cwiseProduct(lambert);
    if (cosine <= 0 || surface.material->gloss <= 0) return;
    const Vector3f halfway = (towards - direction).normalized();
    // Schlick's Fresnel term at 4 % normal reflectance, scaled so that gloss 1 is a wet surface.
    const float grazing = std::pow(1 - std::max(0.0f, halfway.dot(towards)), 5.0f);
    const float fresnel = 0.04f + 0.96f * grazing;
    const float shininess = surface.material->shininess;
    const float lobe =
        (shininess + 8) / 8 * std::pow(std::max(0.0f, surface.normal.dot(halfway)), shininess);
    highlight += surface.material->gloss * fresnel * lobe * cosine * light.radiance;
  }

  const Scene& scene_;
  const RenderOptions& options_;
  TracedScene traced_;
};

Vector3f PixelLight(const Shader& shader, const Scene& scene, const ViewCamera& camera,
                    int samples_per_side, int x, int y) {
  const SampleSequence sequence(x, y);
  Vector3f sum = Vector3f::Zero();
  int index = 0;
  for (int row = 0; row < samples_per_side; ++row) {
    for (int column = 0; column < samples_per_side; ++column, ++index) {
      const Eigen::Vector2d point_px(x - 0.5 + (column + 0.5) / samples_per_side,
                                     y - 0.5 + (row + 0.5) / samples_per_side);
      const auto ray = camera.RayThrough(point_px);
      sum += ray ? shader.Light(*ray, sequence, index) : scene.background;
    }
  }
  return sum / static_cast<float>(index);
}

}  // namespace

std::vector<DirectionalLight> PortraitLights() {
  return {{{0.55, 0.75, 0.95}, {0.72f, 0.69f, 0.65f}, 0.16},
          {{-0.9, 0.15, 0.8}, {0.20f, 0.215f, 0.24f}, 0.25},
          {{-0.6, 0.7, -0.8}, {0.34f, 0.35f, 0.37f}, 0.12}};
}

LinearPicture RenderLinear(const Scene& scene, const ViewCamera& camera,
                           const RenderOptions& options) {
  ARTICAP_CHECK_GT(options.samples_per_side, 0);
  const int width = camera.width();
  const int height = camera.height();
  ARTICAP_CHECK(width > 0 && height > 0);
  LinearPicture picture{width, height, {}};
  picture.rgb.resize(static_cast<std::size_t>(width) * height);
  const Shader shader(scene, options);
  std::atomic<int> next_row = 0;
  const auto render_rows = [&] {
    for (int y = next_row++; y < height; y = next_row++)
      for (int x = 0; x < width; ++x)
        picture.rgb[static_cast<std::size_t>(y) * width + x] =
            PixelLight(shader, scene, camera, options.samples_per_side, x, y);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < options.num_threads; ++i) helpers.emplace_back(render_rows);
  render_rows();
  helpers.clear();
  return picture;
}

Picture Render(const Scene& scene, const ViewCamera& camera, const RenderOptions& options) {
  return EncodeSrgb(RenderLinear(scene, camera, options));
}

}  // namespace articap
