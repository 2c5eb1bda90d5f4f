// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/mesh.h"
#include "core/result.h"

namespace articap {

// The rig frame: mm; x to the speaker's left, y up, z forward; the origin lies between the ears
// (for the default head: midway between the tragia). "Left" is always the speaker's left, at
// positive x.

enum class ParameterUnit : std::uint8_t {
  kRadian,      // rotations
  kMillimetre,  // translations, of the rig's own size
  kWeight,      // morph targets: 0 neutral, 1 the target
};

// One articulatory parameter. Zero is the neutral pose.
struct RigParameter {
  std::string name;
  ParameterUnit unit = ParameterUnit::kWeight;
  double min = 0;
  double max = 1;
  std::string description;  // what a positive value does
  std::string source;       // where the range comes from
};

// A named point of the face at a vertex; the names are the vocabulary of docs/landmarks.md, shared
// by all rigs. A landmark may be a pivot inside the head: a vertex without triangles.
struct Landmark {
  std::string name;
  int vertex = 0;
};

// A weight between 0 and 1 at every vertex of the mesh.
struct WeightMap {
  std::string name;
  std::vector<double> weights;
};

// One weighted geometric transform (Parke 1974; Beskow 1997): with y the value of the parameter, w
// the weight and p the neutral position of a vertex,
//   translate: p += w y vector                   vector: mm per unit of the parameter
//   scale:     p += w y diag(vector) (p - pivot) vector: relative change per unit of the parameter
// Several transforms may belong to one parameter; their displacements add up.
struct WeightedTransform {
  enum class Kind : std::uint8_t { kTranslate, kScale };
  Kind kind = Kind::kTranslate;
  int parameter = 0;
  int weight_map = 0;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  int pivot_vertex = -1;  // of a scale
};

// The mandible: turns about an axis through the condyles and slides. Acts after all displacements:
// with m the displaced vertex, c the pivot, w the weight, R = R(axis, rotation),
//   x = m + w ((R - I)(m - c) + thrust * thrust_direction + shift * shift_direction)
struct JawJoint {
  int weight_map = 0;
  int pivot_vertex = 0;  // midway between the condyles
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Eigen::Vector3d thrust_direction = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d shift_direction = Eigen::Vector3d::UnitX();
  int rotation_parameter = -1;  // rad, positive opens
  int thrust_parameter = -1;    // mm, positive forward
  int shift_parameter = -1;     // mm, positive to the speaker's left
};

// A sparse displacement of the mesh, mm per unit.
struct DisplacementField {
  std::vector<int> vertices;
  std::vector<Eigen::Vector3d> displacements_mm;
};

// A linear morph target (blend shape) that belongs to a parameter.
struct MorphTarget {
  int parameter = 0;
  DisplacementField field;
};

// What makes one head differ from another; 0 is the average head.
struct IdentitySlider {
  std::string name;
  double min = -1;
  double max = 1;
  std::string description;  // what +1 does, with its size
  DisplacementField field;  // pivots move with it
};

// Everything a rig is, as plain data: what rig folders hold and what makers of rigs fill.
struct RigDefinition {
  std::string name;
  TriangleMesh mesh;                    // neutral pose, average identity
  std::vector<Eigen::Vector3f> colors;  // linear RGB albedo of every vertex, 0 to 1
  std::vector<std::string> part_names;  // "skin", "teeth", "tongue", "eyes", "spectacles", ...
  std::vector<std::uint8_t> triangle_part;
  std::vector<std::string> region_names;  // "skull", "upper_lip", "lower_lip", "jaw", ...
  std::vector<std::uint8_t> triangle_region;
  std::vector<Landmark> landmarks;
  std::vector<RigParameter> parameters;
  std::vector<WeightMap> weight_maps;
  std::vector<WeightedTransform> transforms;
  std::vector<MorphTarget> morph_targets;
  std::optional<JawJoint> jaw;
  std::vector<IdentitySlider> identity_sliders;
};

// A talking head that can be posed. Both back-ends, weighted transforms and linear morphs, come
// down to one form: a displacement per parameter and vertex, then at most one jaw joint, so that
// there is one evaluator and one Jacobian.
class FaceRig {
 public:
  // Refuses definitions whose tables disagree in size or point outside one another.
  static Result<FaceRig> Create(RigDefinition definition);

  // The same rig with other identity sliders (values in the order of identity_sliders, all of
  // them): the neutral mesh moves, and all that depends on it follows.
  FaceRig WithIdentity(const Eigen::VectorXd& sliders) const;

  const RigDefinition& definition() const { return definition_; }
  const Eigen::VectorXd& identity() const { return identity_; }
  // Neutral mesh of the current identity, mm, rig frame.
  const TriangleMesh& neutral_mesh() const { return neutral_mesh_; }
  int num_parameters() const { return static_cast<int>(definition_.parameters.size()); }
  int num_vertices() const { return static_cast<int>(neutral_mesh_.vertices.size()); }

  std::optional<int> FindParameter(std::string_view name) const;
  std::optional<int> FindRegion(std::string_view name) const;
  // Vertex of a landmark.
  std::optional<int> FindLandmark(std::string_view name) const;

  // Displacement of the current identity per unit of a parameter; empty for the jaw's parameters.
  const DisplacementField& field(int parameter) const { return fields_[parameter]; }
  // The jaw's weight at a vertex; 0 for rigs without a jaw joint.
  double jaw_weight(int vertex) const;

  // All vertices of a pose, mm, rig frame.
  std::vector<Eigen::Vector3d> Evaluate(const Eigen::VectorXd& parameters) const;

 private:
  FaceRig() = default;
  void CompileFields();

  RigDefinition definition_;
  Eigen::VectorXd identity_;
  TriangleMesh neutral_mesh_;
  std::vector<DisplacementField> fields_;
};

}  // namespace articap
