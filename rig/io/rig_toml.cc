// SPDX-License-Identifier: MIT
#include "rig/io/rig_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "core/toml_reader.h"

namespace articap {
namespace {

constexpr int kFormat = 1;
constexpr std::array<std::string_view, 3> kUnitNames = {"rad", "mm", "weight"};

constexpr std::string_view kHead =
    "# A talking head of articap. Lengths in mm, angles in rad; x to the speaker's left, y up,\n"
    "# z forward, the origin between the ears. Vertices count from 0, as in the CSV tables;\n"
    "# mesh.obj counts from 1.\n";
constexpr std::string_view kTransformHead =
    "\n# With y the parameter, w the weight and p the neutral vertex:\n"
    "#   translate: p += w y vector       scale: p += w y vector * (p - pivot), axis by axis\n";
constexpr std::string_view kJawHead =
    "\n# Acts after all displacements m, about the pivot c:\n"
    "#   x = m + w ((R(axis, rotation) - I)(m - c) + thrust * direction + shift * direction)\n";

std::string List(const std::vector<std::string>& names) {
  std::string text = "[";
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + QuotedToml(names[i]);
  return text + "]";
}

std::string List(const Eigen::Vector3d& vector) {
  return fmt::format("[{}, {}, {}]", TomlFloat(vector.x()), TomlFloat(vector.y()),
                     TomlFloat(vector.z()));
}

std::vector<std::string> NamesOf(const auto& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

// Turns names into indices while a file is read, keeping the first fault.
class NameTable {
 public:
  NameTable(std::vector<std::string> names, std::string_view kind)
      : names_(std::move(names)), kind_(kind) {}

  int Find(const TomlReader& reader, std::string_view key) const {
    const std::string name = reader.Text(key);
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    reader.Fault(key,
                 fmt::format("names the {} '{}', which the file does not define", kind_, name));
    return 0;
  }
  int FindOrNone(const TomlReader& reader, std::string_view key) const {
    return reader.Has(key) ? Find(reader, key) : -1;
  }

 private:
  std::vector<std::string> names_;
  std::string_view kind_;
};

void CheckNames(const TomlReader& reader, std::string_view key, std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) reader.Fault(key, fmt::format("holds the name '{}' twice", *twice));
}

RigParameter ReadParameter(const TomlReader& reader) {
  reader.AllowOnly({"name", "unit", "min", "max", "description", "source"});
  RigParameter parameter;
  parameter.name = reader.Text("name");
  const auto unit = FindUnit(reader.Text("unit"));
  if (!unit) reader.Fault("unit", "is none of rad, mm, weight");
  parameter.unit = unit.value_or(ParameterUnit::kWeight);
  parameter.min = reader.Number("min");
  parameter.max = reader.Number("max");
  parameter.description = reader.Text("description", "");
  parameter.source = reader.Text("source", "");
  return parameter;
}

WeightedTransform ReadTransform(const TomlReader& reader, const NameTable& parameters,
                                const NameTable& maps) {
  reader.AllowOnly({"parameter", "kind", "weights", "vector", "pivot"});
  WeightedTransform transform;
  const std::string kind = reader.Text("kind");
  if (kind != "translate" && kind != "scale")
    reader.Fault("kind", "is neither translate nor scale");
  transform.kind =
      kind == "scale" ? WeightedTransform::Kind::kScale : WeightedTransform::Kind::kTranslate;
  transform.parameter = parameters.Find(reader, "parameter");
  transform.weight_map = maps.Find(reader, "weights");
  transform.vector = reader.Vector("vector");
  transform.pivot_vertex = reader.Integer("pivot", -1);
  return transform;
}

JawJoint ReadJaw(const TomlReader& reader, const NameTable& parameters, const NameTable& maps) {
  reader.AllowOnly({"weights", "pivot", "axis", "thrust_direction", "shift_direction", "rotation",
                    "thrust", "shift"});
  JawJoint jaw;
  jaw.weight_map = maps.Find(reader, "weights");
  jaw.pivot_vertex = reader.Integer("pivot");
  jaw.axis = reader.Vector("axis");
  if (std::abs(jaw.axis.norm() - 1) > 1e-6) reader.Fault("axis", "is not of unit length");
  jaw.thrust_direction = reader.Vector("thrust_direction");
  jaw.shift_direction = reader.Vector("shift_direction");
  jaw.rotation_parameter = parameters.FindOrNone(reader, "rotation");
  jaw.thrust_parameter = parameters.FindOrNone(reader, "thrust");
  jaw.shift_parameter = parameters.FindOrNone(reader, "shift");
  return jaw;
}

void ReadSliders(const TomlReader& root, RigToml& rig) {
  const std::vector<TomlReader> tables = root.Tables("identity");
  rig.identity = Eigen::VectorXd::Zero(static_cast<int>(tables.size()));
  for (const TomlReader& reader : tables) {
    reader.AllowOnly({"name", "min", "max", "value", "description"});
    rig.identity[static_cast<int>(rig.definition.identity_sliders.size())] =
        reader.Number("value", 0.0);
    rig.definition.identity_sliders.push_back({reader.Text("name"),
                                               reader.Number("min"),
                                               reader.Number("max"),
                                               reader.Text("description", ""),
                                               {}});
  }
}

void ReadRoot(const TomlReader& root, RigToml& rig) {
  RigDefinition& definition = rig.definition;
  root.AllowOnly({"format", "name", "parts", "regions", "weight_maps", "landmarks", "parameters",
                  "transforms", "morphs", "jaw", "identity"});
  if (root.Integer("format") != kFormat)
    root.Fault("format", fmt::format("is not {}: the file is from another version", kFormat));
  definition.name = root.Text("name");
  definition.part_names = root.Texts("parts");
  definition.region_names = root.Texts("regions");
  for (const std::string& name : root.Texts("weight_maps"))
    definition.weight_maps.push_back({name, {}});
  for (const TomlReader& reader : root.Tables("landmarks")) {
    reader.AllowOnly({"name", "vertex"});
    definition.landmarks.push_back({reader.Text("name"), reader.Integer("vertex")});
  }
  for (const TomlReader& reader : root.Tables("parameters"))
    definition.parameters.push_back(ReadParameter(reader));

  const NameTable parameters(NamesOf(definition.parameters), "parameter");
  const NameTable maps(NamesOf(definition.weight_maps), "weight map");
  for (const TomlReader& reader : root.Tables("transforms"))
    definition.transforms.push_back(ReadTransform(reader, parameters, maps));
  for (const TomlReader& reader : root.Tables("morphs")) {
    reader.AllowOnly({"parameter"});
    definition.morph_targets.push_back({parameters.Find(reader, "parameter"), {}});
  }
  if (const auto jaw = root.Table("jaw")) definition.jaw = ReadJaw(*jaw, parameters, maps);
  ReadSliders(root, rig);

  CheckNames(root, "parts", definition.part_names);
  CheckNames(root, "regions", definition.region_names);
  CheckNames(root, "weight_maps", NamesOf(definition.weight_maps));
  CheckNames(root, "landmarks", NamesOf(definition.landmarks));
  CheckNames(root, "parameters", NamesOf(definition.parameters));
  CheckNames(root, "identity", NamesOf(definition.identity_sliders));
}

}  // namespace

std::string_view UnitName(ParameterUnit unit) { return kUnitNames[static_cast<int>(unit)]; }

std::optional<ParameterUnit> FindUnit(std::string_view name) {
  const auto found = std::find(kUnitNames.begin(), kUnitNames.end(), name);
  if (found == kUnitNames.end()) return std::nullopt;
  return static_cast<ParameterUnit>(found - kUnitNames.begin());
}

Result<RigToml> ParseRigToml(std::string_view text, const std::string& source) {
  const auto table = ParseToml(text, source);
  if (!table) return tl::unexpected(table.error());
  std::optional<Error> fault;
  RigToml rig;
  ReadRoot(TomlReader(*table, source, fault), rig);
  if (fault) return tl::unexpected(*fault);
  return rig;
}

std::string RigTomlText(const RigDefinition& rig, const Eigen::VectorXd& identity) {
  std::string text(kHead);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "format = {}\nname = {}\nparts = {}\nregions = {}\nweight_maps = {}\n",
                 kFormat, QuotedToml(rig.name), List(rig.part_names), List(rig.region_names),
                 List(NamesOf(rig.weight_maps)));
  fmt::format_to(out, "landmarks = [\n");
  for (const Landmark& landmark : rig.landmarks)
    fmt::format_to(out, "  {{name = {}, vertex = {}}},\n", QuotedToml(landmark.name),
                   landmark.vertex);
  fmt::format_to(out, "]\n");
  for (const RigParameter& parameter : rig.parameters)
    fmt::format_to(out,
                   "\n[[parameters]]\nname = {}\nunit = \"{}\"\nmin = {}\nmax = {}\n"
                   "description = {}\nsource = {}\n",
                   QuotedToml(parameter.name), UnitName(parameter.unit), TomlFloat(parameter.min),
                   TomlFloat(parameter.max), QuotedToml(parameter.description),
                   QuotedToml(parameter.source));
  if (!rig.transforms.empty()) text += kTransformHead;
  for (const WeightedTransform& transform : rig.transforms) {
    const bool scales = transform.kind == WeightedTransform::Kind::kScale;
    fmt::format_to(
        out, "[[transforms]]\nparameter = {}\nkind = \"{}\"\nweights = {}\nvector = {}\n",
        QuotedToml(rig.parameters[transform.parameter].name), scales ? "scale" : "translate",
        QuotedToml(rig.weight_maps[transform.weight_map].name), List(transform.vector));
    if (transform.pivot_vertex != -1) fmt::format_to(out, "pivot = {}\n", transform.pivot_vertex);
    text += '\n';
  }
  for (const MorphTarget& target : rig.morph_targets)
    fmt::format_to(out, "\n[[morphs]]\nparameter = {}\n",
                   QuotedToml(rig.parameters[target.parameter].name));
  if (rig.jaw) {
    text += kJawHead;
    fmt::format_to(out,
                   "[jaw]\nweights = {}\npivot = {}\naxis = {}\nthrust_direction = {}\n"
                   "shift_direction = {}\n",
                   QuotedToml(rig.weight_maps[rig.jaw->weight_map].name), rig.jaw->pivot_vertex,
                   List(rig.jaw->axis), List(rig.jaw->thrust_direction),
                   List(rig.jaw->shift_direction));
    const auto add_parameter = [&](std::string_view key, int parameter) {
      if (parameter >= 0)
        fmt::format_to(out, "{} = {}\n", key, QuotedToml(rig.parameters[parameter].name));
    };
    add_parameter("rotation", rig.jaw->rotation_parameter);
    add_parameter("thrust", rig.jaw->thrust_parameter);
    add_parameter("shift", rig.jaw->shift_parameter);
  }
  for (std::size_t i = 0; i < rig.identity_sliders.size(); ++i) {
    const IdentitySlider& slider = rig.identity_sliders[i];
    fmt::format_to(out,
                   "\n[[identity]]\nname = {}\nmin = {}\nmax = {}\nvalue = {}\ndescription = {}\n",
                   QuotedToml(slider.name), TomlFloat(slider.min), TomlFloat(slider.max),
                   TomlFloat(identity[static_cast<int>(i)]), QuotedToml(slider.description));
  }
  return text;
}

}  // namespace articap
