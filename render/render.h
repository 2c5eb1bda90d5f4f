// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "render/picture.h"
#include "render/view_camera.h"

namespace articap {

// How a surface answers light, beyond its colour.
struct Material {
  float gloss = 0.15f;  // strength of the highlight, 0 matt to 1
  float shininess =
      25.0f;  // exponent of the highlight (Blinn-Phong): larger is smaller and sharper
  float translucence = 0.0f;  // 0 stone, 1 skin: light wraps around, red furthest
  float glow = 0.0f;          // part of the colour that shows without any light, 0 to 1
};

// Triangles with smooth shading, in the scene's frame.
struct RenderMesh {
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> colors;   // linear RGB albedo of every vertex
  std::vector<Eigen::Vector3d> normals;  // unit, one a vertex; empty: VertexNormals(mesh)
  Material material = {};
};

// A marker, or a dot over a landmark.
struct RenderSphere {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 1;
  Eigen::Vector3f color = Eigen::Vector3f::Ones();  // linear RGB
  Material material = {};
};

// A lamp so far away that its rays are parallel, with the size of its disc.
struct DirectionalLight {
  Eigen::Vector3d towards_light = Eigen::Vector3d::UnitY();  // scene's frame; any length
  Eigen::Vector3f radiance = Eigen::Vector3f::Ones();  // linear RGB that a white surface returns
  double angular_radius_rad = 0.1;                     // 0: hard shadows
};

// Soft key from the upper left of the picture, fill from the right, rim from behind.
std::vector<DirectionalLight> PortraitLights();

struct Scene {
  std::vector<RenderMesh> meshes;
  std::vector<RenderSphere> spheres;
  std::vector<DirectionalLight> lights = PortraitLights();
  Eigen::Vector3f ambient = Eigen::Vector3f(0.30f, 0.31f, 0.33f);  // from all sides, linear RGB
  Eigen::Vector3f background = Eigen::Vector3f(0.84f, 0.86f, 0.88f);
};

struct RenderOptions {
  int samples_per_side = 4;  // a pixel averages the square of this many rays
  double occlusion_mm = 60;  // nearer surfaces keep the ambient light away; 0: none do
  bool shadows = true;       // of the directional lights
  int num_threads = 2;       // the picture does not depend on it
};

// Light that arrives at each pixel (box filter). The same input gives the same bytes.
LinearPicture RenderLinear(const Scene& scene, const ViewCamera& camera,
                           const RenderOptions& options = {});

// The same as an sRGB picture.
Picture Render(const Scene& scene, const ViewCamera& camera, const RenderOptions& options = {});

}  // namespace articap
