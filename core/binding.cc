// SPDX-License-Identifier: MIT
#include "core/binding.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/file_io.h"
#include "core/toml_reader.h"

namespace articap {
namespace {

constexpr char kHead[] =
    R"(# A speaker's binding to a talking head, written by articap bind. Lengths in mm, angles in rad.
# rig_from_head: x = (tx, ty, tz, ax, ay, az, s), x_rig = s Rz(az) Ry(ay) Rx(ax) x_head + t.
# A virtual marker lies at v1 + s (v2 - v1) + t (v3 - v1) + u e1, e1 the unit vertex normal at v1.
)";

// The angles pass through a quaternion, which leaves the last digits of a double uncertain.
std::string Rounded(double value) {
  std::string text = fmt::format("{:.13g}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string PointLine(const NamedPoint& point) {
  return fmt::format("{} = [{}, {}, {}]\n", QuotedToml(point.name),
                     TomlFloat(point.point_in_head_mm.x()), TomlFloat(point.point_in_head_mm.y()),
                     TomlFloat(point.point_in_head_mm.z()));
}

std::string ShapeTable(const std::string& name, const HeadShape& shape) {
  std::string text = fmt::format("\n[{}]\n", name);
  for (const NamedPoint& point : shape.points) text += PointLine(point);
  return text;
}

std::string ValueTable(const std::string& name, const std::vector<NamedValue>& values) {
  std::string text = fmt::format("\n[{}]\n", name);
  for (const NamedValue& value : values)
    text += fmt::format("{} = {}\n", QuotedToml(value.name), TomlFloat(value.value));
  return text;
}

std::string VirtualMarkerTable(const VirtualMarker& marker) {
  return fmt::format(
      "\n[[virtual_marker]]\nname = {}\ntriangle = [{}, {}, {}]\ns = {}\nt = {}\nu_mm = {}\n",
      QuotedToml(marker.name), marker.triangle[0], marker.triangle[1], marker.triangle[2],
      TomlFloat(marker.s), TomlFloat(marker.t), TomlFloat(marker.u_mm));
}

std::string SourceTable(const SourceHash& source) {
  return fmt::format("\n[[source]]\nrole = {}\nname = {}\nxxh3 = {}\n", QuotedToml(source.role),
                     QuotedToml(source.name), QuotedToml(source.xxh3));
}

// The marker map as a part of the document: its tables move below [map].
std::string MapTable(const MarkerSet& set) {
  std::string text = "\n[map]\n";
  std::istringstream lines(WriteMarkerSet(set));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[["))
      line.insert(2, "map.");
    else if (line.starts_with("["))
      line.insert(1, "map.");
    text += line + "\n";
  }
  return text;
}

// The keys of a table in the order of the document.
std::vector<std::string> KeysInOrder(const toml::table& table) {
  std::vector<std::pair<toml::source_position, std::string>> keys;
  for (const auto& [key, value] : table)
    keys.emplace_back(key.source().begin, std::string(key.str()));
  std::sort(keys.begin(), keys.end());
  std::vector<std::string> names;
  for (auto& [position, key] : keys) names.push_back(std::move(key));
  return names;
}

HeadShape ReadShape(const TomlReader& document, std::string_view key) {
  HeadShape shape;
  if (const auto table = document.Table(key))
    for (const std::string& name : KeysInOrder(table->table()))
      shape.points.push_back({name, table->Vector(name)});
  return shape;
}

std::vector<NamedValue> ReadValues(const TomlReader& document, std::string_view key) {
  std::vector<NamedValue> values;
  if (const auto table = document.Table(key))
    for (const std::string& name : KeysInOrder(table->table()))
      values.push_back({name, table->Number(name)});
  return values;
}

std::vector<VirtualMarker> ReadVirtualMarkers(const TomlReader& document) {
  std::vector<VirtualMarker> markers;
  for (const TomlReader& table : document.Tables("virtual_marker")) {
    table.AllowOnly({"name", "triangle", "s", "t", "u_mm"});
    const Eigen::Vector3d triangle = table.Vector("triangle");
    // Larger than any mesh, and within int.
    constexpr double kMostVertices = 1e9;
    if (!(triangle.array() >= 0).all() || !(triangle.array() < kMostVertices).all() ||
        (triangle.array() != triangle.array().floor()).any()) {
      table.Fault("triangle", "is not three vertex numbers");
      continue;
    }
    markers.push_back({table.Text("name"), triangle.cast<int>(), table.Number("s"),
                       table.Number("t"), table.Number("u_mm")});
  }
  return markers;
}

std::vector<SourceHash> ReadSources(const TomlReader& document) {
  std::vector<SourceHash> sources;
  for (const TomlReader& table : document.Tables("source")) {
    table.AllowOnly({"role", "name", "xxh3"});
    sources.push_back({table.Text("role"), table.Text("name"), table.Text("xxh3")});
  }
  return sources;
}

Sim3d ReadTransform(const TomlReader& document) {
  const std::vector<double> x = document.Numbers("rig_from_head");
  if (x.size() != 7 || !(x[6] > 0)) {
    document.Fault("rig_from_head", "is not seven numbers with a positive scale at the end");
    return {};
  }
  return Sim3d::FromParameters({x[0], x[1], x[2], x[3], x[4], x[5], x[6]});
}

}  // namespace

std::string WriteBinding(const Binding& binding) {
  std::string text = kHead;
  text += fmt::format("rig = {}\n", QuotedToml(binding.rig_name));
  text += fmt::format("reference_frames = [{}, {}]\n", binding.reference_frames.first,
                      binding.reference_frames.last);
  text += "rig_from_head = [";
  const auto x = binding.rig_from_head.ToParameters();
  for (std::size_t i = 0; i < x.size(); ++i) text += (i == 0 ? "" : ", ") + Rounded(x[i]);
  text += "]\n";
  text += ValueTable("rig_parameters", binding.rig_parameters);
  text += ValueTable("rig_identity", binding.rig_identity);
  text += ShapeTable("head_shape", binding.head_shape);
  text += ShapeTable("reference_pose", binding.reference_pose);
  for (const VirtualMarker& marker : binding.virtual_markers) text += VirtualMarkerTable(marker);
  for (const SourceHash& source : binding.sources) text += SourceTable(source);
  text += MapTable(binding.marker_set);
  return text;
}

Result<Binding> ParseBinding(const std::string& toml_text, const std::string& source_name) {
  const auto document = ParseToml(toml_text, source_name);
  if (!document) return tl::unexpected(document.error());
  std::optional<Error> fault;
  const TomlReader reader(*document, source_name, fault);
  reader.AllowOnly({"rig", "reference_frames", "rig_from_head", "rig_parameters", "rig_identity",
                    "head_shape", "reference_pose", "virtual_marker", "source", "map"});
  Binding binding;
  binding.rig_name = reader.Text("rig");
  const std::vector<double> frames = reader.Numbers("reference_frames");
  if (frames.size() == 2)
    binding.reference_frames = {static_cast<int>(frames[0]), static_cast<int>(frames[1])};
  else
    reader.Fault("reference_frames", "is not the first and the last frame");
  binding.rig_from_head = ReadTransform(reader);
  binding.rig_parameters = ReadValues(reader, "rig_parameters");
  binding.rig_identity = ReadValues(reader, "rig_identity");
  binding.head_shape = ReadShape(reader, "head_shape");
  binding.reference_pose = ReadShape(reader, "reference_pose");
  binding.virtual_markers = ReadVirtualMarkers(reader);
  binding.sources = ReadSources(reader);
  const auto map = reader.Table("map");
  if (!map) reader.Fault("map", "is missing: the marker map that the binding was made with");
  if (fault) return tl::unexpected(*fault);

  std::ostringstream map_text;
  map_text << map->table();
  auto set = ParseMarkerSet(map_text.str(), source_name + " [map]");
  if (!set) return tl::unexpected(set.error());
  binding.marker_set = *std::move(set);
  return binding;
}

Result<Binding> ReadBinding(const std::filesystem::path& path) {
  const auto text = ReadFile(path);
  if (!text) return tl::unexpected(text.error());
  return ParseBinding(*text, path.string());
}

}  // namespace articap
