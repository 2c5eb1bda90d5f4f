// SPDX-License-Identifier: MIT
#include "rig/default_head/default_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rig/default_head/ears.h"
#include "rig/default_head/eyes.h"
#include "rig/default_head/hair.h"
#include "rig/default_head/half_mesh.h"
#include "rig/default_head/identity.h"
#include "rig/default_head/landmarks.h"
#include "rig/default_head/mouth_parts.h"
#include "rig/default_head/rig_file.h"
#include "rig/default_head/skin.h"
#include "rig/default_head/spectacles.h"
#include "rig/default_head/weights.h"

namespace articap {
namespace {

using Eigen::Vector3d;

// Midway between the condyles: in front of and above the tragia's middle, 100 mm behind the lower
// incisors (Bonwill's triangle has sides of 102 mm).
const Vector3d kJawPivot(0, 4, 8);
// Lip rounding narrows the mouth about this point.
const Vector3d kMouthPivot(0, face::kStomionY, 88);

enum class Half { kLeft, kRight, kBoth };

// Values of the half mesh's vertices on the whole head, 0 on the other half where they are one's.
WeightMap SpreadWeights(std::string name, const std::vector<double>& half, const MirrorMap& map,
                        Half side, std::size_t num_vertices) {
  WeightMap weights{std::move(name), std::vector<double>(num_vertices, 0.0)};
  for (std::size_t i = 0; i < half.size(); ++i) {
    if (side != Half::kRight) weights.weights[map.left[i]] = half[i];
    if (side != Half::kLeft) weights.weights[map.right[i]] = half[i];
  }
  return weights;
}

DisplacementField SpreadField(const std::vector<Vector3d>& half, const MirrorMap& map) {
  DisplacementField field;
  const auto add = [&](int vertex, const Vector3d& displacement) {
    field.vertices.push_back(vertex);
    field.displacements_mm.push_back(displacement);
  };
  for (std::size_t i = 0; i < half.size(); ++i) {
    if (half[i].isZero(0)) continue;
    add(map.left[i], half[i]);
    if (map.right[i] != map.left[i])
      add(map.right[i], {-half[i].x(), half[i].y(), half[i].z()});
  }
  return field;
}

template <class Items>
std::optional<int> IndexOf(const Items& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&](const auto& item) { return item.name == name; });
  if (found == items.end()) return std::nullopt;
  return static_cast<int>(found - items.begin());
}

// Looks names of rig.toml up in the definition; remembers the first that it does not find.
class NameLookup {
 public:
  explicit NameLookup(const RigDefinition& definition) : definition_(definition) {}

  int Parameter(const std::string& name) {
    return Find(definition_.parameters, name, "parameter");
  }
  int Weights(const std::string& name) { return Find(definition_.weight_maps, name, "weight map"); }
  int LandmarkVertex(const std::string& name) {
    const int index = Find(definition_.landmarks, name, "landmark");
    return definition_.landmarks[index].vertex;
  }
  const std::string& fault() const { return fault_; }

 private:
  template <class Items>
  int Find(const Items& items, const std::string& name, const char* kind) {
    if (const auto index = IndexOf(items, name)) return *index;
    if (fault_.empty()) fault_ = fmt::format("rig.toml names a {} '{}', which there is not", kind, name);
    return 0;
  }

  const RigDefinition& definition_;
  std::string fault_;
};

// Transforms and jaw joint of rig.toml; needs parameters, weight maps and landmarks in place.
Result<void> AddMotion(const RigFile& file, RigDefinition& definition) {
  NameLookup lookup(definition);
  for (const TransformSpec& spec : file.transforms) {
    WeightedTransform transform;
    transform.kind = spec.kind;
    transform.parameter = lookup.Parameter(spec.parameter);
    transform.weight_map = lookup.Weights(spec.weight);
    transform.vector = spec.vector;
    if (spec.kind == WeightedTransform::Kind::kScale)
      transform.pivot_vertex = lookup.LandmarkVertex(spec.about);
    definition.transforms.push_back(transform);
  }
  JawJoint jaw;
  jaw.weight_map = lookup.Weights("jaw");
  jaw.pivot_vertex = lookup.LandmarkVertex(file.jaw.pivot);
  jaw.axis = file.jaw.axis.normalized();
  jaw.thrust_direction = file.jaw.thrust_direction;
  jaw.shift_direction = file.jaw.shift_direction;
  jaw.rotation_parameter = lookup.Parameter(file.jaw.rotation);
  jaw.thrust_parameter = lookup.Parameter(file.jaw.thrust);
  jaw.shift_parameter = lookup.Parameter(file.jaw.shift);
  if (!lookup.fault().empty()) return Fail(lookup.fault());
  definition.jaw = jaw;
  return {};
}

// The half mesh with all its parts.
struct HalfHead {
  FaceShape shape;
  HalfMesh mesh;
  Skin skin;
  KnownVertices known;
};

HalfHead MakeHalfHead() {
  HalfHead head;
  HalfMesh& mesh = head.mesh;
  head.skin = AddSkin(head.shape, mesh);
  head.known.eye_center = AddEyeball(mesh);
  AddBrow(head.shape, mesh);
  AddEar(mesh);
  AddHair(head.shape, mesh);
  head.known.incisors = AddTeeth(mesh);
  AddTongue(mesh);
  head.known.spectacles = AddSpectacles(mesh);
  const auto add_pivot = [&](const Vector3d& at) {
    return mesh.AddVertex(at, Eigen::Vector3f::Zero(), Part::kSkin, Carrier::kSkull);
  };
  head.known.jaw_pivot = add_pivot(kJawPivot);
  head.known.mouth_pivot = add_pivot(kMouthPivot);
  return head;
}

void AddWeightMaps(const RigFile& file, const HalfHead& head, const LipDistances& distances,
                   const std::vector<double>& jaw_weights, const MirrorMap& map,
                   RigDefinition& definition) {
  const std::size_t size = definition.mesh.vertices.size();
  std::vector<WeightMap>& maps = definition.weight_maps;
  maps.push_back(SpreadWeights("jaw", jaw_weights, map, Half::kBoth, size));
  for (const LipWeightSpec& spec : file.lip_weights) {
    const std::vector<double> weights = LipWeights(spec, distances, head.mesh, head.skin);
    const Half side = spec.mirror.empty() ? Half::kBoth : Half::kLeft;
    maps.push_back(SpreadWeights(spec.name, weights, map, side, size));
    if (side == Half::kLeft)
      maps.push_back(SpreadWeights(spec.mirror, weights, map, Half::kRight, size));
  }
}

}  // namespace

Result<FaceRig> MakeDefaultHead() {
  Result<RigFile> file = ParseRigFile(DefaultRigToml(), "rig/default_head/rig.toml");
  if (!file) return Fail(file.error().message);
  const HalfHead head = MakeHalfHead();
  const LipDistances lip_distances(head.mesh, head.skin);
  const std::vector<double> jaw_weights = JawWeights(head.mesh, head.skin);

  RigDefinition definition;
  definition.name = file->name;
  const MirrorMap map = MirrorHalf(head.mesh, definition);
  definition.landmarks =
      MirrorLandmarks(FindLandmarks(head.mesh, head.skin, head.shape, head.known), map);
  definition.parameters = file->parameters;
  AddWeightMaps(*file, head, lip_distances, jaw_weights, map, definition);
  if (Result<void> added = AddMotion(*file, definition); !added) return Fail(added.error().message);

  const IdentityInputs inputs{head.mesh, head.skin, head.shape, lip_distances, jaw_weights, kJawPivot};
  for (IdentitySlider& slider : file->identity) {
    const auto field = IdentityField(slider.name, inputs);
    if (!field) return Fail(field.error().message);
    slider.field = SpreadField(*field, map);
    definition.identity_sliders.push_back(std::move(slider));
  }
  return FaceRig::Create(std::move(definition));
}

}  // namespace articap
