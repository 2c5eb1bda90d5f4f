// SPDX-License-Identifier: MIT
#include "rig/io/rig_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <system_error>

#include "core/file_io.h"
#include "rig/io/obj_mesh.h"
#include "rig/io/rig_toml.h"
#include "rig/io/text_scan.h"

namespace articap {
namespace {

constexpr const char* kToml = "rig.toml";
constexpr const char* kMesh = "mesh.obj";
constexpr const char* kWeights = "weights.csv";
constexpr const char* kMorphs = "morphs.csv";
constexpr const char* kIdentity = "identity.csv";
constexpr std::string_view kWeightsHeader = "vertex,map,weight";
constexpr std::string_view kMorphsHeader = "morph,vertex,dx_mm,dy_mm,dz_mm";
constexpr std::string_view kIdentityHeader = "slider,vertex,dx_mm,dy_mm,dz_mm";

std::optional<int> IndexOf(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<int>(found - names.begin());
}

// Calls `take(fields)` for every line of a CSV table; it says what is wrong with the line, or
// nothing.
template <class Take>
Result<void> ReadTable(std::string_view text, const std::string& source, std::string_view header,
                       Take take) {
  LineScanner lines(text);
  std::string_view line;
  if (!lines.Next(line) || line != header)
    return Fail(fmt::format("{}, line 1: the header '{}' is missing", source, header));
  const auto num_columns =
      static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  std::vector<std::string_view> fields;
  while (lines.Next(line)) {
    SplitAtCommas(line, fields);
    std::optional<std::string> fault;
    if (fields.size() != num_columns)
      fault = fmt::format("{} columns instead of {}", fields.size(), num_columns);
    else
      fault = take(fields);
    if (fault) return Fail(fmt::format("{}, line {}: {}", source, lines.line_number(), *fault));
  }
  return {};
}

std::optional<int> ParseVertex(std::string_view field, std::size_t num_vertices) {
  const auto vertex = ParseInteger(field);
  if (!vertex || *vertex < 0 || static_cast<std::size_t>(*vertex) >= num_vertices)
    return std::nullopt;
  return vertex;
}

// Group "part region" of every triangle.
Result<void> TakeMesh(const ObjMesh& obj, const std::string& source, RigDefinition& rig) {
  struct Group {
    int part, region;
  };
  std::vector<Group> groups;
  for (const std::string& name : obj.group_names) {
    const auto blank = std::min(name.find(' '), name.size());
    const auto part = IndexOf(rig.part_names, name.substr(0, blank));
    const auto region =
        IndexOf(rig.region_names, blank < name.size() ? name.substr(blank + 1) : "");
    if (!part || !region)
      return Fail(
          fmt::format("{}: the group '{}' is not a part and a region of rig.toml", source, name));
    groups.push_back({*part, *region});
  }
  for (const ObjMesh::Face& face : obj.faces) {
    if (face.num_corners != 3)
      return Fail(fmt::format("{}: a face has {} corners; rig folders hold triangles", source,
                              face.num_corners));
    const int* corners = obj.face_corners(face);
    rig.mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
    rig.triangle_part.push_back(static_cast<std::uint8_t>(groups[face.group].part));
    rig.triangle_region.push_back(static_cast<std::uint8_t>(groups[face.group].region));
  }
  if (obj.colors.empty())
    return Fail(fmt::format("{}: the vertices have no colours (v x y z r g b)", source));
  rig.mesh.vertices = obj.vertices;
  rig.colors = obj.colors;
  return {};
}

Result<void> TakeWeights(std::string_view text, const std::string& source, RigDefinition& rig) {
  std::vector<std::string> names;
  for (const WeightMap& map : rig.weight_maps) names.push_back(map.name);
  return ReadTable(text, source, kWeightsHeader,
                   [&](const auto& fields) -> std::optional<std::string> {
                     const auto vertex = ParseVertex(fields[0], rig.mesh.vertices.size());
                     const auto map = IndexOf(names, fields[1]);
                     const auto weight = ParseNumber(fields[2]);
                     if (!vertex) return fmt::format("there is no vertex '{}'", fields[0]);
                     if (!map) return fmt::format("there is no weight map '{}'", fields[1]);
                     if (!weight) return fmt::format("'{}' is not a finite number", fields[2]);
                     rig.weight_maps[*map].weights[*vertex] = *weight;
                     return std::nullopt;
                   });
}

// Morphs and identity sliders: find_field maps the first column to a field, or to nullptr.
template <class FindField>
Result<void> TakeFields(std::string_view text, const std::string& source, std::string_view header,
                        std::size_t num_vertices, FindField find_field) {
  return ReadTable(text, source, header, [&](const auto& fields) -> std::optional<std::string> {
    DisplacementField* field = find_field(fields[0]);
    if (!field) return fmt::format("rig.toml does not define '{}'", fields[0]);
    const auto vertex = ParseVertex(fields[1], num_vertices);
    if (!vertex) return fmt::format("there is no vertex '{}'", fields[1]);
    Eigen::Vector3d displacement_mm;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = ParseNumber(fields[axis + 2]);
      if (!value) return fmt::format("'{}' is not a finite number", fields[axis + 2]);
      displacement_mm[axis] = *value;
    }
    field->vertices.push_back(*vertex);
    field->displacements_mm.push_back(displacement_mm);
    return std::nullopt;
  });
}

Result<void> TakeTables(const RigFiles& files, const std::string& source, RigDefinition& rig) {
  for (WeightMap& map : rig.weight_maps) map.weights.assign(rig.mesh.vertices.size(), 0.0);
  const auto find = [&](const char* name) -> const std::string* {
    const auto file = files.find(name);
    return file == files.end() ? nullptr : &file->second;
  };
  Result<void> taken;
  if (const std::string* text = find(kWeights))
    taken = TakeWeights(*text, source + "/" + kWeights, rig);
  if (const std::string* text = find(kMorphs); text && taken)
    taken = TakeFields(*text, source + "/" + kMorphs, kMorphsHeader, rig.mesh.vertices.size(),
                       [&](std::string_view field) -> DisplacementField* {
                         const auto morph = ParseVertex(field, rig.morph_targets.size());
                         return morph ? &rig.morph_targets[*morph].field : nullptr;
                       });
  if (const std::string* text = find(kIdentity); text && taken)
    taken = TakeFields(*text, source + "/" + kIdentity, kIdentityHeader, rig.mesh.vertices.size(),
                       [&](std::string_view field) -> DisplacementField* {
                         for (IdentitySlider& slider : rig.identity_sliders)
                           if (slider.name == field) return &slider.field;
                         return nullptr;
                       });
  return taken;
}

void AppendField(std::string_view name, const DisplacementField& field, std::string& text) {
  for (std::size_t i = 0; i < field.vertices.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", name, field.vertices[i],
                   field.displacements_mm[i].x(), field.displacements_mm[i].y(),
                   field.displacements_mm[i].z());
}

// Names become OBJ groups and CSV fields, which have no quotes.
Result<void> CheckNamesForFiles(const RigDefinition& rig) {
  std::vector<std::string> names = rig.part_names;
  names.insert(names.end(), rig.region_names.begin(), rig.region_names.end());
  for (const WeightMap& map : rig.weight_maps) names.push_back(map.name);
  for (const IdentitySlider& slider : rig.identity_sliders) names.push_back(slider.name);
  for (const std::string& name : names)
    if (name.empty() || name.find_first_of(" \t\r\n,") != std::string::npos)
      return Fail(
          fmt::format("rig '{}' cannot be saved: the name '{}' is empty or holds a blank or a "
                      "comma; use underscores",
                      rig.name, name));
  return {};
}

bool HoldsOnlyARig(const std::filesystem::path& folder) {
  static const std::vector<std::string> kNames = {kToml, kMesh, kWeights, kMorphs, kIdentity};
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (!IndexOf(kNames, entry.path().filename().string())) return false;
  return !error;
}

}  // namespace

Result<FaceRig> ParseRig(const RigFiles& files, const std::string& source) {
  for (const char* name : {kToml, kMesh})
    if (!files.contains(name))
      return Fail(
          fmt::format("{}: the file {} is missing; is this the folder of a rig?", source, name));
  auto toml = ParseRigToml(files.at(kToml), source + "/" + kToml);
  if (!toml) return tl::unexpected(toml.error());
  const auto obj = ParseObj(files.at(kMesh), source + "/" + kMesh);
  if (!obj) return tl::unexpected(obj.error());
  RigDefinition& definition = toml->definition;
  const std::size_t most = std::numeric_limits<std::uint8_t>::max() + 1;
  if (definition.part_names.size() > most || definition.region_names.size() > most ||
      definition.weight_maps.size() > most)
    return Fail(fmt::format("{}: more than {} parts, regions or weight maps", source, most));
  auto taken = TakeMesh(*obj, source + "/" + kMesh, definition);
  if (taken) taken = TakeTables(files, source, definition);
  if (!taken) return tl::unexpected(taken.error());
  auto rig = FaceRig::Create(std::move(definition));
  if (!rig) return Fail(fmt::format("{}: {}", source, rig.error().message));
  if (toml->identity.isZero(0)) return rig;
  return rig->WithIdentity(toml->identity);
}

Result<FaceRig> LoadRig(const std::filesystem::path& folder) {
  RigFiles files;
  for (const char* name : {kToml, kMesh, kWeights, kMorphs, kIdentity}) {
    std::error_code error;
    if (!std::filesystem::exists(folder / name, error)) continue;
    auto bytes = ReadFile(folder / name);
    if (!bytes) return tl::unexpected(bytes.error());
    files[name] = std::move(*bytes);
  }
  return ParseRig(files, folder.string());
}

RigFiles SerializeRig(const FaceRig& rig) {
  const RigDefinition& definition = rig.definition();
  RigFiles files;
  files[kToml] = RigTomlText(definition, rig.identity());
  std::vector<std::string> groups;
  for (std::size_t i = 0; i < definition.mesh.triangles.size(); ++i)
    groups.push_back(definition.part_names[definition.triangle_part[i]] + " " +
                     definition.region_names[definition.triangle_region[i]]);
  files[kMesh] =
      ObjText(definition.mesh.vertices, definition.mesh.triangles, definition.colors, groups);

  std::string weights;
  for (const WeightMap& map : definition.weight_maps)
    for (std::size_t i = 0; i < map.weights.size(); ++i)
      if (map.weights[i] != 0)
        fmt::format_to(std::back_inserter(weights), "{},{},{}\n", i, map.name, map.weights[i]);
  std::string morphs;
  for (std::size_t i = 0; i < definition.morph_targets.size(); ++i)
    AppendField(std::to_string(i), definition.morph_targets[i].field, morphs);
  std::string identity;
  for (const IdentitySlider& slider : definition.identity_sliders)
    AppendField(slider.name, slider.field, identity);
  const auto add = [&](const char* name, std::string_view header, const std::string& lines) {
    if (!lines.empty()) files[name] = fmt::format("{}\n{}", header, lines);
  };
  add(kWeights, kWeightsHeader, weights);
  add(kMorphs, kMorphsHeader, morphs);
  add(kIdentity, kIdentityHeader, identity);
  return files;
}

Result<void> SaveRig(const FaceRig& rig, const std::filesystem::path& folder) {
  if (auto checked = CheckNamesForFiles(rig.definition()); !checked) return checked;
  const RigFiles files = SerializeRig(rig);
  // What cannot be read back must not be written.
  if (const auto parsed = ParseRig(files, folder.string()); !parsed)
    return Fail(fmt::format("the rig cannot be saved: {}", parsed.error().message));
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !HoldsOnlyARig(folder))
    return Fail(
        fmt::format("{}: holds other things than a rig; choose a new folder", folder.string()));
  // Written aside under a temporary name, so that nobody finds half a rig.
  std::filesystem::path aside = folder;
  if (!aside.has_filename()) aside = aside.parent_path();
  aside += ".part";
  std::filesystem::remove_all(aside, error);
  for (const auto& [name, bytes] : files)
    if (auto written = WriteFile(aside / name, bytes); !written) {
      std::filesystem::remove_all(aside, error);
      return written;
    }
  std::filesystem::remove_all(folder, error);
  std::filesystem::rename(aside, folder, error);
  if (error)
    return Fail(fmt::format("{}: cannot be put in place ({}); the rig is in {}", folder.string(),
                            error.message(), aside.string()));
  return {};
}

std::string HashOf(const FaceRig& rig) {
  std::string bytes;
  for (const auto& [name, text] : SerializeRig(rig))
    bytes += fmt::format("{} {}\n{}", name, text.size(), text);
  return HashOf(std::string_view(bytes));
}

}  // namespace articap
