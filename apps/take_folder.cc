// SPDX-License-Identifier: MIT
#include "apps/take_folder.h"

#include <fmt/format.h>

#include <system_error>

namespace articap {

TakeFolder::~TakeFolder() {
  std::error_code ignored;
  if (!kept_ && !path_.empty()) std::filesystem::remove_all(path_, ignored);
}

Result<TakeFolder> MakeTakeFolder(const std::filesystem::path& takes, const std::string& id) {
  std::error_code error;
  std::filesystem::create_directories(takes, error);
  for (int version = 1; !error; ++version) {
    const std::filesystem::path folder =
        takes / (version == 1 ? id : fmt::format("{}_v{}", id, version));
    if (std::filesystem::create_directory(folder, error)) return TakeFolder(folder);
    if (error == std::errc::file_exists) error.clear();
  }
  return Fail(fmt::format("{}: no folder for a take can be made ({}); check the session's rights",
                          takes.string(), error.message()));
}

}  // namespace articap
