// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"

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

// A flat round sticker, seen from its front alone. It lies on a surface that need not be flat: what
// of that rises over it by up to give_mm beneath it gives way, so that its outline is the circle's.
// It throws no shadow.
struct RenderDisc {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, out of its front
  double radius_mm = 2;
  double give_mm = 1;
  Eigen::Vector3f color = Eigen::Vector3f::Ones();  // linear RGB
  Material material = {};
};

// A wet or greasy place of the meshes, which shines more sharply than their material.
struct RenderWetSpot {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 5;  // where the shine has faded
  float gloss = 1.5f;    // of a lamp's radiance, where it is reflected to the viewer
  float shininess = 250;

  // What a place with this unit normal shines, before the lamp's colour. halfway: between the
  // directions to the lamp and to the viewer, unit.
  float ShineAt(const Eigen::Vector3f& position_mm, const Eigen::Vector3f& normal,
                const Eigen::Vector3f& halfway) const;
};

// A rectangular plane mirror in a frame. It turns rays of sight alone: it neither throws shadows
// nor lights, and its glass has no reflection of its own.
struct RenderMirror {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  // of the reflecting surface
  // Unit, out of the mirror's back, as in core/camera.h.
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  // the height runs along it, within the plane
  double width_mm = 200;                          // of what reflects
  double height_mm = 200;
  double glass_mm = 0;  // a second-surface mirror: glass of this thickness lies before the plane
  double glass_index = 1.52;
  float reflectance = 0.92f;
  double frame_mm = 0;  // how far the frame reaches beyond what reflects
  // Frame and back, without shading; linear RGB.
  Eigen::Vector3f frame_color = Eigen::Vector3f::Constant(0.02f);
};

// A lamp so far away that its rays are parallel, with the size of its disc.
struct DirectionalLight {
  Eigen::Vector3d towards_light = Eigen::Vector3d::UnitY();  // scene's frame; any length
  Eigen::Vector3f radiance = Eigen::Vector3f::Ones();  // linear RGB that a white surface returns
  double angular_radius_rad = 0.1;                     // 0: hard shadows
};

// Soft key from the upper right of the picture, fill from the left, rim from behind.
std::vector<DirectionalLight> PortraitLights();

struct Scene {
  std::vector<RenderMesh> meshes;
  std::vector<RenderSphere> spheres;
  std::vector<RenderDisc> discs = {};
  std::vector<RenderWetSpot> wet_spots = {};
  std::vector<RenderMirror> mirrors = {};
  std::vector<DirectionalLight> lights = PortraitLights();
  Eigen::Vector3f ambient = Eigen::Vector3f(0.29f, 0.30f, 0.32f);  // from all sides, linear RGB
  Eigen::Vector3f background = Eigen::Vector3f(0.84f, 0.86f, 0.88f);
};

}  // namespace articap
