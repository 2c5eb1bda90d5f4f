// SPDX-License-Identifier: MIT
#include "rig/face_rig.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "core/check.h"

namespace articap {
namespace {

template <class Items>
std::optional<int> FindByName(const Items& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  if (found == items.end()) return std::nullopt;
  return static_cast<int>(found - items.begin());
}

bool IsIndex(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

// The displacement of one transform at one vertex, per unit of its parameter.
Eigen::Vector3d UnitDisplacement(const WeightedTransform& transform, double weight,
                                 const TriangleMesh& mesh, int vertex) {
  if (transform.kind == WeightedTransform::Kind::kTranslate) return weight * transform.vector;
  const Eigen::Vector3d arm = mesh.vertices[vertex] - mesh.vertices[transform.pivot_vertex];
  return weight * transform.vector.cwiseProduct(arm);
}

// A parameter of the jaw joint that transforms or morph targets use as well, which one evaluator
// and one skinned joint could not carry.
std::optional<std::string> ParameterOfJawAndSkin(const RigDefinition& rig) {
  for (const int parameter :
       {rig.jaw->rotation_parameter, rig.jaw->thrust_parameter, rig.jaw->shift_parameter}) {
    const auto is_it = [&](const auto& user) { return user.parameter == parameter; };
    if (std::any_of(rig.transforms.begin(), rig.transforms.end(), is_it) ||
        std::any_of(rig.morph_targets.begin(), rig.morph_targets.end(), is_it))
      return rig.parameters[parameter].name;
  }
  return std::nullopt;
}

// Why a definition cannot be a rig; nothing where it can.
std::optional<std::string> FindFault(const RigDefinition& rig) {
  const std::size_t num_vertices = rig.mesh.vertices.size();
  const std::size_t num_triangles = rig.mesh.triangles.size();
  const auto field_fits = [&](const DisplacementField& field) {
    return field.vertices.size() == field.displacements_mm.size() &&
           std::all_of(field.vertices.begin(), field.vertices.end(),
                       [&](int vertex) { return IsIndex(vertex, num_vertices); });
  };

  for (const Eigen::Vector3d& vertex : rig.mesh.vertices)
    if (!vertex.allFinite()) return "the mesh has a vertex that is not finite";
  for (const Eigen::Vector3i& triangle : rig.mesh.triangles)
    for (const int vertex : {triangle[0], triangle[1], triangle[2]})
      if (!IsIndex(vertex, num_vertices))
        return fmt::format("a triangle names vertex {} of {}", vertex, num_vertices);
  if (rig.colors.size() != num_vertices)
    return fmt::format("{} colours for {} vertices", rig.colors.size(), num_vertices);
  if (rig.triangle_part.size() != num_triangles || rig.triangle_region.size() != num_triangles)
    return fmt::format("{} parts and {} regions for {} triangles", rig.triangle_part.size(),
                       rig.triangle_region.size(), num_triangles);
  for (std::size_t i = 0; i < num_triangles; ++i)
    if (!IsIndex(rig.triangle_part[i], rig.part_names.size()) ||
        !IsIndex(rig.triangle_region[i], rig.region_names.size()))
      return fmt::format("triangle {} belongs to a part or region without a name", i);
  for (const Landmark& landmark : rig.landmarks)
    if (!IsIndex(landmark.vertex, num_vertices))
      return fmt::format("landmark '{}' is at vertex {} of {}", landmark.name, landmark.vertex,
                         num_vertices);
  for (const RigParameter& parameter : rig.parameters)
    if (!(parameter.min <= 0 && parameter.max >= 0 && parameter.min < parameter.max))
      return fmt::format("parameter '{}' has the range {} to {}, which must contain 0",
                         parameter.name, parameter.min, parameter.max);
  for (const WeightMap& map : rig.weight_maps) {
    if (map.weights.size() != num_vertices)
      return fmt::format("weight map '{}' has {} weights for {} vertices", map.name,
                         map.weights.size(), num_vertices);
    for (const double weight : map.weights)
      if (!(weight >= 0 && weight <= 1))
        return fmt::format("weight map '{}' holds {}, not between 0 and 1", map.name, weight);
  }
  for (const WeightedTransform& transform : rig.transforms) {
    if (!IsIndex(transform.parameter, rig.parameters.size()) ||
        !IsIndex(transform.weight_map, rig.weight_maps.size()))
      return "a transform names a parameter or weight map that does not exist";
    if (transform.kind == WeightedTransform::Kind::kScale &&
        !IsIndex(transform.pivot_vertex, num_vertices))
      return "a scaling has no pivot";
  }
  for (const MorphTarget& target : rig.morph_targets)
    if (!IsIndex(target.parameter, rig.parameters.size()) || !field_fits(target.field))
      return "a morph target names a parameter or vertex that does not exist";
  for (const IdentitySlider& slider : rig.identity_sliders)
    if (!field_fits(slider.field))
      return fmt::format("identity slider '{}' names a vertex that does not exist", slider.name);
  if (rig.jaw) {
    if (!IsIndex(rig.jaw->weight_map, rig.weight_maps.size()) ||
        !IsIndex(rig.jaw->pivot_vertex, num_vertices))
      return "the jaw has no weight map or no pivot";
    for (const int parameter :
         {rig.jaw->rotation_parameter, rig.jaw->thrust_parameter, rig.jaw->shift_parameter})
      if (parameter != -1 && !IsIndex(parameter, rig.parameters.size()))
        return "the jaw names a parameter that does not exist";
    if (const auto name = ParameterOfJawAndSkin(rig))
      return fmt::format("the parameter '{}' is the jaw's and displaces vertices besides", *name);
  }
  return std::nullopt;
}

double ValueOr0(const Eigen::VectorXd& parameters, int index) {
  return index < 0 ? 0.0 : parameters[index];
}

}  // namespace

Result<FaceRig> FaceRig::Create(RigDefinition definition) {
  if (const auto fault = FindFault(definition))
    return Fail(fmt::format("rig '{}' is inconsistent: {}", definition.name, *fault));
  FaceRig rig;
  rig.identity_ = Eigen::VectorXd::Zero(static_cast<int>(definition.identity_sliders.size()));
  rig.neutral_mesh_ = definition.mesh;
  rig.definition_ = std::move(definition);
  rig.CompileFields();
  return rig;
}

FaceRig FaceRig::WithIdentity(const Eigen::VectorXd& sliders) const {
  ARTICAP_CHECK_EQ(sliders.size(), static_cast<int>(definition_.identity_sliders.size()));
  FaceRig rig = *this;
  rig.identity_ = sliders;
  rig.neutral_mesh_ = definition_.mesh;
  for (int i = 0; i < sliders.size(); ++i) {
    const DisplacementField& field = definition_.identity_sliders[i].field;
    for (std::size_t k = 0; k < field.vertices.size(); ++k)
      rig.neutral_mesh_.vertices[field.vertices[k]] += sliders[i] * field.displacements_mm[k];
  }
  rig.CompileFields();
  return rig;
}

std::optional<int> FaceRig::FindParameter(std::string_view name) const {
  return FindByName(definition_.parameters, name);
}

std::optional<int> FaceRig::FindRegion(std::string_view name) const {
  const auto& names = definition_.region_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

std::optional<int> FaceRig::FindLandmark(std::string_view name) const {
  const auto index = FindByName(definition_.landmarks, name);
  if (!index) return std::nullopt;
  return definition_.landmarks[*index].vertex;
}

double FaceRig::jaw_weight(int vertex) const {
  if (!definition_.jaw) return 0;
  return definition_.weight_maps[definition_.jaw->weight_map].weights[vertex];
}

void FaceRig::CompileFields() {
  const int num_vertices = static_cast<int>(neutral_mesh_.vertices.size());
  fields_.assign(definition_.parameters.size(), {});
  std::vector<Eigen::Vector3d> dense(num_vertices);
  for (int parameter = 0; parameter < num_parameters(); ++parameter) {
    std::fill(dense.begin(), dense.end(), Eigen::Vector3d::Zero());
    for (const WeightedTransform& transform : definition_.transforms) {
      if (transform.parameter != parameter) continue;
      const std::vector<double>& weights = definition_.weight_maps[transform.weight_map].weights;
      for (int vertex = 0; vertex < num_vertices; ++vertex)
        if (weights[vertex] > 0)
          dense[vertex] += UnitDisplacement(transform, weights[vertex], neutral_mesh_, vertex);
    }
    for (const MorphTarget& target : definition_.morph_targets) {
      if (target.parameter != parameter) continue;
      for (std::size_t k = 0; k < target.field.vertices.size(); ++k)
        dense[target.field.vertices[k]] += target.field.displacements_mm[k];
    }
    DisplacementField& field = fields_[parameter];
    for (int vertex = 0; vertex < num_vertices; ++vertex) {
      if (dense[vertex].isZero(0)) continue;
      field.vertices.push_back(vertex);
      field.displacements_mm.push_back(dense[vertex]);
    }
  }
}

std::vector<Eigen::Vector3d> FaceRig::Evaluate(const Eigen::VectorXd& parameters) const {
  ARTICAP_CHECK_EQ(parameters.size(), num_parameters());
  std::vector<Eigen::Vector3d> vertices = neutral_mesh_.vertices;
  for (int i = 0; i < num_parameters(); ++i) {
    const DisplacementField& field = fields_[i];
    for (std::size_t k = 0; k < field.vertices.size(); ++k)
      vertices[field.vertices[k]] += parameters[i] * field.displacements_mm[k];
  }
  if (!definition_.jaw) return vertices;

  const JawJoint& jaw = *definition_.jaw;
  const std::vector<double>& weights = definition_.weight_maps[jaw.weight_map].weights;
  const Eigen::Vector3d pivot = neutral_mesh_.vertices[jaw.pivot_vertex];
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(ValueOr0(parameters, jaw.rotation_parameter), jaw.axis).toRotationMatrix() -
      Eigen::Matrix3d::Identity();
  const Eigen::Vector3d slide = ValueOr0(parameters, jaw.thrust_parameter) * jaw.thrust_direction +
                                ValueOr0(parameters, jaw.shift_parameter) * jaw.shift_direction;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (weights[i] > 0) vertices[i] += weights[i] * (turn * (vertices[i] - pivot) + slide);
  return vertices;
}

}  // namespace articap
