// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "rig/default_head/half_mesh.h"
#include "rig/default_head/rig_file.h"
#include "rig/default_head/skin.h"

namespace articap::default_head {

// Distances over the skin outside of the vermilion, by which lip weights and lip thickness decay.
class LipDistances {
 public:
  LipDistances(const HalfMesh& half, const Skin& skin);

  struct Nearest {
    double distance_mm;
    int column;  // of the border ring
  };
  // For every node of the skin's layout, the nearest vertex of the vermilion border (of both lips,
  // or of one), along the surface.
  std::vector<Nearest> FromBorder(bool upper, bool lower) const;

  // Takes the edges of nearest-vertex regions out of a field on the layout's nodes; the border
  // keeps its values.
  void Smooth(std::vector<double>& values) const;

 private:
  struct Edge {
    int to;
    double length_mm;
  };
  const Skin& skin_;
  std::vector<std::vector<Edge>> edges_;  // of the layout's nodes
  std::vector<bool> on_border_;
};

// Weight at every vertex of the half mesh.
std::vector<double> LipWeights(const LipWeightSpec& spec, const LipDistances& distances,
                               const HalfMesh& half, const Skin& skin);

// How far each vertex goes with the mandible: 1 on chin and lower lip, 0.5 at the corners of the
// mouth, 0 above the cheekbones and low on the neck, smooth along the surface between them.
std::vector<double> JawWeights(const HalfMesh& half, const Skin& skin);

}  // namespace articap::default_head
