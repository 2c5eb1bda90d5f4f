// SPDX-License-Identifier: MIT
#include "tests/support/test_data.h"

#include <unistd.h>

#include <cstdlib>

namespace articap {

std::filesystem::path TestDataFolder() {
  if (const char* folder = std::getenv("ARTICAP_TEST_DATA")) return folder;
  return SourceFolder().parent_path() / "shared" / "data";
}

std::filesystem::path TestDataPath(const std::string& relative) {
  return TestDataFolder() / relative;
}

bool HasTestData(const std::string& relative) {
  return std::filesystem::exists(TestDataPath(relative));
}

std::filesystem::path SourceFolder() { return ARTICAP_SOURCE_DIR; }

std::filesystem::path MakeTemporaryFolder(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / (name + "." + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace articap
