// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "rig/face_rig.h"

namespace articap {

enum class Part : std::uint8_t { kSkin, kHair, kBrows, kEyes, kTeeth, kGums, kTongue, kSpectacles };
inline constexpr const char* kPartNames[] = {"skin",  "hair", "brows",  "eyes",
                                             "teeth", "gums", "tongue", "spectacles"};

enum class Region : std::uint8_t {
  kSkull,
  kNose,
  kUpperLip,
  kLowerLip,
  kJaw,
  kLeftCheek,
  kRightCheek,
  kNeck,
  kInside,
  kTeethUpper,
  kTeethLower,
  kTongue,
  kEyes,
  kSpectacles
};
inline constexpr const char* kRegionNames[] = {
    "skull",  "nose",        "upper_lip",   "lower_lip", "jaw",  "left_cheek", "right_cheek",
    "neck",   "inside",      "teeth_upper", "teeth_lower", "tongue", "eyes",     "spectacles"};

// How far a vertex goes with the mandible apart from the skin's smooth weights: the parts inside the
// mouth are rigid, the skin is not.
enum class Carrier : std::uint8_t { kSkin, kSkull, kMandible, kTongue };

// The speaker's left half of a head (x >= 0) while it is being made. What lies on the midline has
// x = 0 exactly and belongs to both halves.
struct HalfMesh {
  struct Vertex {
    Eigen::Vector3d position;  // mm, rig frame
    Eigen::Vector3f color;     // linear RGB
    Part part;
    Carrier carrier;
  };
  struct Triangle {
    Eigen::Vector3i corners;  // counter-clockwise seen from outside
    Part part;
    Region region;
  };
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;

  int AddVertex(const Eigen::Vector3d& position, const Eigen::Vector3f& color, Part part,
                Carrier carrier);
  void AddTriangle(int a, int b, int c, Part part, Region region);
  // The quad a b c d, cut along its shorter diagonal.
  void AddQuad(int a, int b, int c, int d, Part part, Region region);

  const Eigen::Vector3d& position(int vertex) const { return vertices[vertex].position; }
};

// Which vertices of the whole head a vertex of the half became.
struct MirrorMap {
  std::vector<int> left;   // of each vertex of the half
  std::vector<int> right;  // the same vertex on the midline
};

// Both halves: fills mesh, colours, parts and regions of the definition.
MirrorMap MirrorHalf(const HalfMesh& half, RigDefinition& definition);

// Linear RGB of an sRGB colour 0xRRGGBB.
Eigen::Vector3f LinearRgb(std::uint32_t srgb);

}  // namespace articap
