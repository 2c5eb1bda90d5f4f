// SPDX-License-Identifier: MIT
#include "apps/resources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <system_error>
#include <vector>

namespace articap {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> MapFolders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return {program.parent_path().parent_path() / "share" / "articap" / "maps",
          fs::path(ARTICAP_SOURCE_DIR) / "maps"};
}

std::set<std::string> KnownMaps() {
  std::set<std::string> names;
  for (const fs::path& folder : MapFolders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  }
  return names;
}

}  // namespace

Result<fs::path> FindMap(const std::string& name_or_path) {
  std::error_code error;
  if (fs::is_regular_file(name_or_path, error)) return fs::path(name_or_path);
  if (name_or_path.find('/') == std::string::npos)
    for (const fs::path& folder : MapFolders()) {
      const fs::path path = folder / (name_or_path + ".toml");
      if (fs::is_regular_file(path, error)) return path;
    }
  return Fail(
      fmt::format("map {}: no such file, and no map of that name comes with articap; give "
                  "the path of a marker map, or one of: {}",
                  name_or_path, fmt::join(KnownMaps(), ", ")));
}

std::filesystem::path MapInput(const std::string& name_or_path) {
  if (name_or_path.empty()) return {};
  const auto path = FindMap(name_or_path);
  return path ? *path : std::filesystem::path();
}

}  // namespace articap
