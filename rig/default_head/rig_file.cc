// SPDX-License-Identifier: MIT
#include "rig/default_head/rig_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>

namespace articap {
namespace {

// A table of the file whose missing or ill-typed fields are told by table, name and line.
class Fields {
 public:
  Fields(const toml::table& table, std::string_view what, std::string_view file)
      : table_(table), what_(what), file_(file) {}

  std::string Text(std::string_view key) { return Get<std::string>(key, "a text"); }
  double Number(std::string_view key) { return Get<double>(key, "a number"); }

  Eigen::Vector3d Vector(std::string_view key) {
    const toml::array* array = table_[key].as_array();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    if (array == nullptr || array->size() != 3) return Miss(key, "three numbers"), vector;
    for (int i = 0; i < 3; ++i) vector[i] = (*array)[i].value_or(0.0);
    return vector;
  }

  std::vector<Eigen::Vector2d> Pairs(std::string_view key) {
    std::vector<Eigen::Vector2d> pairs;
    if (const toml::array* array = table_[key].as_array())
      for (const toml::node& node : *array)
        if (const toml::array* pair = node.as_array(); pair != nullptr && pair->size() == 2)
          pairs.emplace_back((*pair)[0].value_or(0.0), (*pair)[1].value_or(0.0));
    if (pairs.size() < 2) Miss(key, "two or more pairs of numbers");
    return pairs;
  }

  bool Has(std::string_view key) const { return table_.contains(key); }

  // The first fault; empty where there is none.
  const std::string& fault() const { return fault_; }
  void Miss(std::string_view key, std::string_view expected) {
    if (fault_.empty())
      fault_ = fmt::format("{}, line {}: [{}] needs '{}' = {}", file_, table_.source().begin.line,
                           what_, key, expected);
  }

 private:
  template <class T>
  T Get(std::string_view key, std::string_view expected) {
    if (const auto value = table_[key].value<T>()) return *value;
    Miss(key, expected);
    return T{};
  }

  const toml::table& table_;
  std::string what_, file_, fault_;
};

RigParameter ReadParameter(Fields& fields) {
  RigParameter parameter;
  parameter.name = fields.Text("name");
  const std::string unit = fields.Text("unit");
  if (unit == "rad")
    parameter.unit = ParameterUnit::kRadian;
  else if (unit == "mm")
    parameter.unit = ParameterUnit::kMillimetre;
  else
    fields.Miss("unit", "\"rad\" or \"mm\"");
  parameter.min = fields.Number("min");
  parameter.max = fields.Number("max");
  parameter.description = fields.Text("description");
  parameter.source = fields.Text("source");
  return parameter;
}

LipWeightSpec ReadLipWeight(Fields& fields) {
  LipWeightSpec weight;
  weight.name = fields.Text("name");
  if (fields.Has("mirror")) weight.mirror = fields.Text("mirror");
  const std::string lips = fields.Text("lips");
  weight.on_upper = lips == "upper" || lips == "both";
  weight.on_lower = lips == "lower" || lips == "both";
  if (!weight.on_upper && !weight.on_lower)
    fields.Miss("lips", "\"upper\", \"lower\" or \"both\"");
  weight.along = fields.Pairs("along");
  weight.reach_mm = fields.Number("reach_mm");
  return weight;
}

TransformSpec ReadTransform(Fields& fields) {
  TransformSpec transform;
  transform.parameter = fields.Text("parameter");
  transform.weight = fields.Text("weight");
  if (fields.Has("scale")) {
    transform.kind = WeightedTransform::Kind::kScale;
    transform.vector = fields.Vector("scale");
    transform.about = fields.Text("about");
  } else {
    transform.vector = fields.Vector("translate");
  }
  return transform;
}

JawSpec ReadJaw(Fields& fields) {
  JawSpec jaw;
  jaw.pivot = fields.Text("pivot");
  jaw.axis = fields.Vector("axis");
  jaw.thrust_direction = fields.Vector("thrust_direction");
  jaw.shift_direction = fields.Vector("shift_direction");
  jaw.rotation = fields.Text("rotation");
  jaw.thrust = fields.Text("thrust");
  jaw.shift = fields.Text("shift");
  return jaw;
}

IdentitySlider ReadIdentity(Fields& fields) {
  IdentitySlider slider;
  slider.name = fields.Text("name");
  slider.min = fields.Number("min");
  slider.max = fields.Number("max");
  slider.description = fields.Text("description");
  return slider;
}

// Reads every [[key]] of the file; returns the first fault.
template <class Item, class Read>
std::string ReadTables(const toml::table& root, std::string_view key, std::string_view file,
                       Read read, std::vector<Item>& items) {
  const toml::array* tables = root[key].as_array();
  if (tables == nullptr) return fmt::format("{}: no [[{}]]", file, key);
  for (const toml::node& node : *tables) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return fmt::format("{}: '{}' is not a list of tables", file, key);
    Fields fields(*table, key, file);
    items.push_back(read(fields));
    if (!fields.fault().empty()) return fields.fault();
  }
  return "";
}

}  // namespace

Result<RigFile> ParseRigFile(std::string_view text, std::string_view source_name) {
  toml::table root;
  try {
    root = toml::parse(text, source_name);
  } catch (const toml::parse_error& error) {
    return Fail(fmt::format("{}, line {}: {}", source_name, error.source().begin.line,
                            error.description()));
  }
  RigFile rig;
  rig.name = root["name"].value_or(std::string("rig"));
  std::string fault = ReadTables(root, "parameter", source_name, ReadParameter, rig.parameters);
  if (fault.empty())
    fault = ReadTables(root, "lip_weight", source_name, ReadLipWeight, rig.lip_weights);
  if (fault.empty())
    fault = ReadTables(root, "transform", source_name, ReadTransform, rig.transforms);
  if (fault.empty()) fault = ReadTables(root, "identity", source_name, ReadIdentity, rig.identity);
  if (!fault.empty()) return Fail(fault);
  const toml::table* jaw = root["jaw"].as_table();
  if (jaw == nullptr) return Fail(fmt::format("{}: no [jaw]", source_name));
  Fields fields(*jaw, "jaw", source_name);
  rig.jaw = ReadJaw(fields);
  if (!fields.fault().empty()) return Fail(fields.fault());
  return rig;
}

}  // namespace articap
