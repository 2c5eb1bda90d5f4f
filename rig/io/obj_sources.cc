// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "rig/io/import.h"
#include "rig/io/makehuman_target.h"
#include "rig/io/obj_mesh.h"

namespace articap {
namespace {

// Displacements smaller than this part of the mesh's size are rounding of the file's decimals.
constexpr double kRelativeRounding = 1e-7;

MorphSource SourceOf(const ObjMesh& obj, const std::string& name) {
  MorphSource source;
  source.name = name;
  source.vertices = obj.vertices;
  source.colors = obj.colors;
  source.group_names = obj.group_names;
  for (const ObjMesh::Face& face : obj.faces) {
    AppendTriangles(obj.vertices, obj.face_corners(face), face.num_corners, source.triangles);
    source.triangle_group.resize(source.triangles.size(), face.group);
  }
  return source;
}

double SizeOf(const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::Vector3d low = vertices.front();
  Eigen::Vector3d high = vertices.front();
  for (const Eigen::Vector3d& vertex : vertices) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  return (high - low).norm();
}

bool SameFaces(const ObjMesh& a, const ObjMesh& b) {
  return a.corners == b.corners &&
         std::equal(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(),
                    [](const ObjMesh::Face& first, const ObjMesh::Face& second) {
                      return first.num_corners == second.num_corners;
                    });
}

// File name without folder and extension(s).
std::string TargetName(const std::string& file_name, std::string_view extension) {
  return file_name.substr(0, file_name.size() - extension.size());
}

}  // namespace

Result<MorphSource> ReadObjTargets(const std::map<std::string, std::string>& files,
                                   const std::string& source_name) {
  constexpr const char* kNeutral = "neutral.obj";
  const auto neutral_file = files.find(kNeutral);
  if (neutral_file == files.end())
    return Fail(
        fmt::format("{}: there is no {}; a folder of OBJ targets holds {} and one OBJ file for "
                    "each target, with the same vertices and faces",
                    source_name, kNeutral, kNeutral));
  const auto neutral = ParseObj(neutral_file->second, source_name + "/" + kNeutral);
  if (!neutral) return tl::unexpected(neutral.error());
  MorphSource source = SourceOf(*neutral, source_name);
  const double rounding = kRelativeRounding * SizeOf(neutral->vertices);
  for (const auto& [name, bytes] : files) {
    if (name == kNeutral || !name.ends_with(".obj")) continue;
    const std::string path = fmt::format("{}/{}", source_name, name);
    const auto target = ParseObj(bytes, path);
    if (!target) return tl::unexpected(target.error());
    if (target->vertices.size() != neutral->vertices.size() || !SameFaces(*target, *neutral))
      return Fail(
          fmt::format("{}: {} vertices and {} faces do not match the {} and {} of {}; export "
                      "all targets from one mesh, keeping the order of its vertices",
                      path, target->vertices.size(), target->faces.size(), neutral->vertices.size(),
                      neutral->faces.size(), kNeutral));
    MorphSource::Target morph{TargetName(name, ".obj"), {}};
    for (std::size_t i = 0; i < target->vertices.size(); ++i) {
      const Eigen::Vector3d displacement = target->vertices[i] - neutral->vertices[i];
      if (displacement.norm() <= rounding) continue;
      morph.field.vertices.push_back(static_cast<int>(i));
      morph.field.displacements_mm.push_back(displacement);
    }
    source.targets.push_back(std::move(morph));
  }
  return source;
}

Result<MorphSource> ReadMakeHuman(const std::string& base_obj,
                                  const std::map<std::string, std::string>& target_files,
                                  const std::string& source_name) {
  const auto base = ParseObj(base_obj, source_name);
  if (!base) return tl::unexpected(base.error());
  MorphSource source = SourceOf(*base, source_name);
  source.mm_per_unit = 100;  // MakeHuman works in decimetres
  for (const auto& [name, bytes] : target_files) {
    const std::string_view extension = name.ends_with(".target.gz") ? ".target.gz" : ".target";
    if (!name.ends_with(extension)) continue;
    auto field = ParseMakeHumanTarget(bytes, static_cast<int>(source.vertices.size()), name);
    if (!field) return tl::unexpected(field.error());
    source.targets.push_back({TargetName(name, extension), std::move(*field)});
  }
  return source;
}

}  // namespace articap
