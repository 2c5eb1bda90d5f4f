// SPDX-License-Identifier: MIT
#include "rig/default_head/identity.h"

#include <fmt/format.h>

#include <algorithm>

#include "rig/default_head/curve.h"

namespace articap {
namespace {

using Eigen::Vector3d;
using Field = std::vector<Vector3d>;

constexpr double kBrowForward_mm = 3;
constexpr double kBrowDown_mm = 1;

// An eyeball keeps its shape: it moves as its centre does.
Vector3d AnchorOf(const HalfMesh::Vertex& vertex) {
  return vertex.part == Part::kEyes ? Vector3d(face::kPupilX, face::kPupilY, face::kEyeZ)
                                    : vertex.position;
}

Field WidthField(const IdentityInputs& in) {
  Field field;
  for (const HalfMesh::Vertex& vertex : in.half.vertices)
    field.emplace_back(AnchorOf(vertex).x(), 0, 0);
  return field;
}

Field LengthField(const IdentityInputs& in) {
  Field field;
  for (const HalfMesh::Vertex& vertex : in.half.vertices)
    field.emplace_back(0, AnchorOf(vertex).y(), 0);
  return field;
}

// The lips grow about their seam; the skin near them makes room.
Field LipField(const IdentityInputs& in) {
  constexpr double kReach_mm = 15;
  constexpr double kFullness = 0.6;  // part of the relative change that goes into protrusion
  const Skin& skin = in.skin;
  const auto growth = [&](int vertex, int k) -> Vector3d {
    const Vector3d arm =
        in.half.position(vertex) - in.half.position(skin.mouth_rings[skin.seam_ring][k]);
    return {0, arm.y(), kFullness * std::max(arm.z(), 0.0)};
  };
  const std::vector<int>& border = skin.mouth_rings[skin.border_ring];
  const auto nearest = in.lip_distances.FromBorder(true, true);
  std::vector<double> y(nearest.size()), z(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const Vector3d at_border = growth(border[nearest[i].column], nearest[i].column);
    const double decay = SmoothStep(kReach_mm, 0, nearest[i].distance_mm);
    y[i] = decay * at_border.y();
    z[i] = decay * at_border.z();
  }
  in.lip_distances.Smooth(y);
  in.lip_distances.Smooth(z);
  Field field(in.half.vertices.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < nearest.size(); ++i) field[i] = {0, y[i], z[i]};
  for (int ring = skin.border_ring; ring <= skin.seam_ring; ++ring)
    for (int k = 0; k < skin.num_mouth_columns(); ++k)
      field[skin.mouth_rings[ring][k]] = growth(skin.mouth_rings[ring][k], k);
  return field;
}

// The chin and the edge of the jaw move away from the condyles; lips and teeth stay.
Field JawField(const IdentityInputs& in) {
  Field field(in.half.vertices.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < in.skin.layout.nodes.size(); ++i) {
    const Vector3d& p = in.half.position(static_cast<int>(i));
    const double below_lip = SmoothStep(-60, -80, p.y());
    const Vector3d arm = p - in.jaw_pivot;
    field[i] = in.jaw_weights[i] * below_lip * Vector3d(0, arm.y(), arm.z());
  }
  return field;
}

Field NoseField(const IdentityInputs& in) {
  constexpr double kBreadth = 0.5;
  Field field(in.half.vertices.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < in.skin.layout.nodes.size(); ++i) {
    const double relief_mm = in.shape.NoseRelief(in.skin.layout.nodes[i]);
    const double on_nose = SmoothStep(0, 8, relief_mm);
    field[i] = {kBreadth * on_nose * in.half.position(static_cast<int>(i)).x(), 0, relief_mm};
  }
  return field;
}

Field BrowField(const IdentityInputs& in) {
  Field field(in.half.vertices.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < field.size(); ++i) {
    const HalfMesh::Vertex& vertex = in.half.vertices[i];
    const bool skin = i < in.skin.layout.nodes.size();
    if (!skin && vertex.part != Part::kBrows) continue;
    const Vector3d& p = vertex.position;
    const double facing = SmoothStep(20, 60, p.z());
    const double ridge = facing * Bell((p.y() - 34) / 4.5) * SmoothStep(62, 38, p.x());
    field[i] = {0, -kBrowDown_mm * ridge, kBrowForward_mm * ridge};
  }
  return field;
}

}  // namespace

Result<Field> IdentityField(const std::string& name, const IdentityInputs& inputs) {
  if (name == "face_width") return WidthField(inputs);
  if (name == "face_length") return LengthField(inputs);
  if (name == "lip_thickness") return LipField(inputs);
  if (name == "jaw_length") return JawField(inputs);
  if (name == "nose") return NoseField(inputs);
  if (name == "brow") return BrowField(inputs);
  return Fail(fmt::format("the default head has no identity slider '{}'", name));
}

}  // namespace articap
