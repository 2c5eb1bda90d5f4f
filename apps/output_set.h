// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"

namespace articap {

// The files that a verb leaves, which appear all together or not at all: they are written under
// temporary names beside their places first, and take their places when all are whole.
class OutputSet {
 public:
  void Add(const std::filesystem::path& path, std::string bytes);
  // For writers that need a path of their own, such as HDF5's.
  void AddWriter(const std::filesystem::path& path,
                 std::function<Result<void>(const std::filesystem::path&)> write);

  const std::vector<std::filesystem::path>& paths() const { return paths_; }

  // Refused where an output would take the place of an input: a raw recording is never altered.
  Result<void> RefuseToOverwrite(const std::vector<std::filesystem::path>& inputs) const;
  Result<void> Commit() const;

 private:
  std::vector<std::filesystem::path> paths_;
  std::vector<std::function<Result<void>(const std::filesystem::path&)>> writers_;
};

}  // namespace articap
