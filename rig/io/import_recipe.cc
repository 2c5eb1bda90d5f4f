// SPDX-License-Identifier: MIT
#include "rig/io/import_recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "core/toml_reader.h"
#include "rig/io/rig_toml.h"

namespace articap {
namespace {

std::optional<Eigen::Vector3f> ReadColor(const TomlReader& reader) {
  if (!reader.Has("color")) return std::nullopt;
  const Eigen::Vector3d color = reader.Vector("color");
  if (color.minCoeff() < 0 || color.maxCoeff() > 1)
    reader.Fault("color", "is not between 0 and 1 (linear RGB)");
  return color.cast<float>();
}

std::optional<std::array<double, 2>> ReadRange(const TomlReader& reader, std::string_view key) {
  if (!reader.Has(key)) return std::nullopt;
  const std::vector<double> range = reader.Numbers(key);
  if (range.size() == 2 && range[0] < range[1]) return std::array{range[0], range[1]};
  reader.Fault(key, "is not a range of two rising numbers");
  return std::nullopt;
}

int ReadSide(const TomlReader& reader) {
  const std::string side = reader.Text("side", "both");
  if (side != "both" && side != "left" && side != "right")
    reader.Fault("side", "is none of left, right, both");
  return side == "left" ? 1 : side == "right" ? -1 : 0;
}

std::optional<ImportRecipe::MovedBy> ReadMovedBy(const TomlReader& reader) {
  const auto table = reader.Table("moved_by");
  if (!table) return std::nullopt;
  table->AllowOnly({"target", "range_mm"});
  const auto range_mm = ReadRange(*table, "range_mm");
  if (!range_mm) table->Fault("range_mm", "is missing");
  return ImportRecipe::MovedBy{table->Text("target"), range_mm.value_or(std::array{0.0, 0.0})};
}

ImportRecipe::Part ReadPart(const TomlReader& reader) {
  reader.AllowOnly({"name", "groups", "color", "plane_point_mm", "plane_normal"});
  ImportRecipe::Part part;
  part.name = reader.Text("name");
  part.groups = reader.Texts("groups");
  part.color = ReadColor(reader);
  if (reader.Has("plane_point_mm")) part.plane_point_mm = reader.Vector("plane_point_mm");
  if (reader.Has("plane_normal")) part.plane_normal = reader.Vector("plane_normal");
  return part;
}

ImportRecipe::Region ReadRegion(const TomlReader& reader) {
  reader.AllowOnly({"name", "parts", "outline_mm", "depth_mm", "facing", "moved_by", "side",
                    "fill_from", "color"});
  ImportRecipe::Region region;
  region.name = reader.Text("name");
  region.parts = reader.Texts("parts");
  region.outline_mm = reader.Points2d("outline_mm");
  if (!region.outline_mm.empty() && region.outline_mm.size() < 3)
    reader.Fault("outline_mm", "has fewer than three points");
  region.depth_mm = ReadRange(reader, "depth_mm");
  if (reader.Has("facing")) region.facing = reader.Vector("facing");
  region.moved_by = ReadMovedBy(reader);
  region.side = ReadSide(reader);
  if (reader.Has("fill_from")) region.fill_from = reader.Integer("fill_from");
  region.color = ReadColor(reader);
  return region;
}

ImportRecipe::TargetUse ReadTargetUse(const TomlReader& reader) {
  reader.AllowOnly(
      {"target", "gain", "side", "side_blend_mm", "below_mm", "moved_by", "lateral_mm"});
  ImportRecipe::TargetUse use;
  use.target = reader.Text("target");
  use.gain = reader.Number("gain", 1.0);
  use.side = ReadSide(reader);
  use.side_blend_mm = reader.Number("side_blend_mm", use.side_blend_mm);
  if (!(use.side_blend_mm > 0)) reader.Fault("side_blend_mm", "is not positive");
  if (reader.Has("below_mm")) use.below_mm = reader.Number("below_mm");
  use.moved_by = ReadMovedBy(reader);
  use.lateral_mm = ReadRange(reader, "lateral_mm");
  return use;
}

ImportRecipe::Parameter ReadParameter(const TomlReader& reader) {
  reader.AllowOnly({"name", "unit", "min", "max", "description", "source", "joint", "targets"});
  ImportRecipe::Parameter parameter;
  const auto unit = FindUnit(reader.Text("unit", "weight"));
  if (!unit) reader.Fault("unit", "is none of rad, mm, weight");
  parameter.parameter = {
      reader.Text("name"),       unit.value_or(ParameterUnit::kWeight), reader.Number("min", 0.0),
      reader.Number("max", 1.0), reader.Text("description", ""),        reader.Text("source", "")};
  parameter.joint = reader.Text("joint", "");
  if (!parameter.joint.empty() && parameter.joint != "rotation" && parameter.joint != "thrust" &&
      parameter.joint != "shift")
    reader.Fault("joint", "is none of rotation, thrust, shift");
  for (const TomlReader& target : reader.Tables("targets"))
    parameter.targets.push_back(ReadTargetUse(target));
  return parameter;
}

ImportRecipe::Jaw ReadJaw(const TomlReader& reader) {
  reader.AllowOnly({"target", "angle_deg", "pivot_mm", "rigid_groups", "fixed_groups", "soft_mm",
                    "smoothing_rounds"});
  ImportRecipe::Jaw jaw;
  jaw.target = reader.Text("target");
  const double angle_deg = reader.Number("angle_deg");
  if (!(angle_deg > 0 && angle_deg < 90)) reader.Fault("angle_deg", "is not between 0 and 90");
  jaw.angle_rad = angle_deg * std::numbers::pi / 180;
  jaw.pivot_mm = reader.Vector("pivot_mm");
  jaw.rigid_groups = reader.Texts("rigid_groups");
  jaw.fixed_groups = reader.Texts("fixed_groups");
  jaw.soft_mm = reader.Number("soft_mm", jaw.soft_mm);
  if (!(jaw.soft_mm > 0)) reader.Fault("soft_mm", "is not positive");
  jaw.smoothing_rounds = std::clamp(reader.Integer("smoothing_rounds", 0), 0, 100);
  return jaw;
}

void ReadRoot(const TomlReader& root, ImportRecipe& recipe) {
  root.AllowOnly({"name", "unit", "axes", "origin_between", "parts", "landmarks", "regions",
                  "parameters", "jaw"});
  recipe.name = root.Text("name", "");
  recipe.unit = root.Text("unit", "");
  if (!recipe.unit.empty() && !MillimetresPer(recipe.unit))
    root.Fault("unit", "is none of mm, cm, dm, m, in");
  const auto read_pair = [&](std::string_view key, std::array<std::string, 2>& pair) {
    if (!root.Has(key)) return;
    const std::vector<std::string> texts = root.Texts(key);
    if (texts.size() != 2) return root.Fault(key, "is not a list of two texts");
    pair = {texts[0], texts[1]};
  };
  read_pair("axes", recipe.axes);
  read_pair("origin_between", recipe.origin_between);
  for (const TomlReader& part : root.Tables("parts")) recipe.parts.push_back(ReadPart(part));
  for (const TomlReader& landmark : root.Tables("landmarks")) {
    landmark.AllowOnly({"name", "vertex"});
    recipe.landmarks.push_back({landmark.Text("name"), landmark.Integer("vertex")});
  }
  for (const TomlReader& region : root.Tables("regions"))
    recipe.regions.push_back(ReadRegion(region));
  for (const TomlReader& parameter : root.Tables("parameters"))
    recipe.parameters.push_back(ReadParameter(parameter));
  if (const auto jaw = root.Table("jaw")) recipe.jaw = ReadJaw(*jaw);
}

}  // namespace

Result<ImportRecipe> ParseImportRecipe(std::string_view text, const std::string& source) {
  const auto table = ParseToml(text, source);
  if (!table) return tl::unexpected(table.error());
  std::optional<Error> fault;
  ImportRecipe recipe;
  ReadRoot(TomlReader(*table, source, fault), recipe);
  if (fault) return tl::unexpected(*fault);
  return recipe;
}

std::optional<double> MillimetresPer(std::string_view unit) {
  if (unit == "mm") return 1.0;
  if (unit == "cm") return 10.0;
  if (unit == "dm") return 100.0;
  if (unit == "m") return 1000.0;
  if (unit == "in") return 25.4;
  return std::nullopt;
}

}  // namespace articap
