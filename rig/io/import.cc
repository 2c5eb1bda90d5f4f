// SPDX-License-Identifier: MIT
#include "rig/io/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/check.h"
#include "core/file_io.h"
#include "rig/io/gltf_import.h"
#include "rig/io/hm08_recipe.h"

namespace articap {
namespace {

using Files = std::map<std::string, std::string>;

// All files of a folder with one of the extensions.
Result<Files> ReadFolder(const std::filesystem::path& folder,
                         std::initializer_list<std::string_view> extensions) {
  std::error_code error;
  Files files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (std::none_of(extensions.begin(), extensions.end(),
                     [&](std::string_view extension) { return name.ends_with(extension); }))
      continue;
    auto bytes = ReadFile(entry.path());
    if (!bytes) return tl::unexpected(bytes.error());
    files[name] = std::move(*bytes);
  }
  if (error)
    return Fail(fmt::format("{}: cannot be listed ({})", folder.string(), error.message()));
  return files;
}

Result<StageResult<FaceRig>> ImportObjFolder(const std::filesystem::path& folder,
                                             const std::optional<ImportRecipe>& recipe,
                                             const ImportOptions& options) {
  const auto files = ReadFolder(folder, {".obj", "rig.toml"});
  if (!files) return tl::unexpected(files.error());
  auto source = ReadObjTargets(*files, folder.string());
  if (!source) return tl::unexpected(source.error());
  source->name = std::filesystem::absolute(folder / ".").parent_path().filename().string();
  if (recipe) return BuildMorphRig(*source, *recipe, options);
  const auto own = files->find("rig.toml");
  if (own == files->end()) return BuildMorphRig(*source, ImportRecipe{}, options);
  const auto own_recipe = ParseImportRecipe(own->second, (folder / "rig.toml").string());
  if (!own_recipe) return tl::unexpected(own_recipe.error());
  return BuildMorphRig(*source, *own_recipe, options);
}

Result<StageResult<FaceRig>> ImportMakeHuman(const std::filesystem::path& base_obj,
                                             const std::optional<ImportRecipe>& recipe,
                                             const ImportOptions& options) {
  const auto base = ReadFile(base_obj);
  if (!base) return tl::unexpected(base.error());
  const auto targets = ReadFolder(base_obj.parent_path() / "targets", {".target", ".target.gz"});
  if (!targets) return tl::unexpected(targets.error());
  auto source = ReadMakeHuman(*base, *targets, base_obj.string());
  if (!source) return tl::unexpected(source.error());
  source->name = "makehuman";
  return BuildMorphRig(*source, recipe ? *recipe : MakeHumanRecipe(), options);
}

}  // namespace

const ImportRecipe& MakeHumanRecipe() {
  static const ImportRecipe recipe = [] {
    auto parsed = ParseImportRecipe(kHm08Recipe, "hm08.toml");
    ARTICAP_CHECK(parsed.has_value());
    return std::move(*parsed);
  }();
  return recipe;
}

Result<StageResult<FaceRig>> ImportRig(const std::filesystem::path& path,
                                       const std::optional<ImportRecipe>& recipe,
                                       const ImportOptions& options) {
  std::error_code error;
  const std::string extension = path.extension().string();
  if (std::filesystem::is_directory(path, error)) {
    if (std::filesystem::exists(path / "base.obj", error))
      return ImportMakeHuman(path / "base.obj", recipe, options);
    return ImportObjFolder(path, recipe, options);
  }
  if (extension == ".glb" || extension == ".gltf") {
    const auto source = ReadGltfTargets(path);
    if (!source) return tl::unexpected(source.error());
    return BuildMorphRig(*source, recipe ? *recipe : ImportRecipe{}, options);
  }
  if (extension == ".obj") return ImportMakeHuman(path, recipe, options);
  return Fail(
      fmt::format("{}: no rig that can be imported; name a .glb or .gltf file, MakeHuman's "
                  "base.obj, or a folder with neutral.obj and an OBJ file for each target",
                  path.string()));
}

}  // namespace articap
