// SPDX-License-Identifier: MIT
#include "apps/output_set.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include "core/file_io.h"

namespace articap {
namespace {

namespace fs = std::filesystem;

// Makes the folders on the way to a file and remembers which are new.
Result<void> MakeFolders(const fs::path& folder, std::vector<fs::path>& made) {
  if (folder.empty()) return {};
  std::error_code error;
  if (fs::is_directory(folder, error)) return {};
  if (Result<void> parents = MakeFolders(folder.parent_path(), made); !parents) return parents;
  if (!fs::create_directory(folder, error) && error)
    return Fail(fmt::format("{}: the folder cannot be made ({}); name another place for the output",
                            folder.string(), error.message()));
  made.push_back(folder);
  return {};
}

// Whatever was begun is taken away again unless it was kept.
class Undo {
 public:
  ~Undo() {
    std::error_code ignored;
    for (const fs::path& file : files) fs::remove(file, ignored);
    std::for_each(folders.rbegin(), folders.rend(),
                  [&](const fs::path& folder) { fs::remove(folder, ignored); });
  }
  void Keep() {
    files.clear();
    folders.clear();
  }
  std::vector<fs::path> files;
  std::vector<fs::path> folders;
};

}  // namespace

void OutputSet::Add(const fs::path& path, std::string bytes) {
  AddWriter(path, [shared = std::make_shared<const std::string>(std::move(bytes))](
                      const fs::path& place) { return WriteFile(place, *shared); });
}

void OutputSet::AddWriter(const fs::path& path,
                          std::function<Result<void>(const fs::path&)> write) {
  paths_.push_back(path.lexically_normal());
  writers_.push_back(std::move(write));
}

Result<void> OutputSet::RefuseToOverwrite(const std::vector<fs::path>& inputs) const {
  for (const fs::path& output : paths_)
    for (const fs::path& input : inputs) {
      std::error_code error;
      // Also by name: the way to the output may lead through folders that are yet to be made.
      if (fs::equivalent(output, input, error) ||
          (!input.empty() &&
           fs::weakly_canonical(output, error) == fs::weakly_canonical(input, error)))
        return Fail(
            fmt::format("{}: the output would take the place of the input, which is never "
                        "altered; give the output another name",
                        output.string()));
    }
  return {};
}

Result<void> OutputSet::Commit() const {
  Undo undo;
  std::vector<fs::path> parts;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (Result<void> made = MakeFolders(paths_[i].parent_path(), undo.folders); !made) return made;
    std::error_code error;
    if (fs::is_directory(paths_[i], error))
      return Fail(fmt::format("{}: is a folder, where a file is to be written; name another output",
                              paths_[i].string()));
    if (fs::exists(paths_[i], error) && !fs::is_regular_file(paths_[i], error))
      return Fail(
          fmt::format("{}: is a device or a pipe, where a file is to be written; name "
                      "another output",
                      paths_[i].string()));
    if (std::find(paths_.begin(), paths_.begin() + static_cast<std::ptrdiff_t>(i), paths_[i]) !=
        paths_.begin() + static_cast<std::ptrdiff_t>(i))
      return Fail(fmt::format("{}: two outputs have this name; name one of them otherwise",
                              paths_[i].string()));
    parts.push_back(paths_[i]);
    parts.back() += fmt::format(".{}.new", ::getpid());
    undo.files.push_back(parts.back());
    if (Result<void> written = writers_[i](parts[i]); !written) return written;
  }
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    std::error_code error;
    fs::rename(parts[i], paths_[i], error);
    if (error)
      return Fail(
          fmt::format("{}: cannot be put in its place ({})", paths_[i].string(), error.message()));
  }
  undo.Keep();
  return {};
}

}  // namespace articap
