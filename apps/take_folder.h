// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include "core/result.h"

namespace articap {

// Leaves room for "_v1000", so that the next version's name is safe too.
constexpr std::size_t kLongestTakeId = 90;

// The folder of a take while it is filled; taken away again unless it was kept.
class TakeFolder {
 public:
  explicit TakeFolder(std::filesystem::path path) : path_(std::move(path)) {}
  ~TakeFolder();
  TakeFolder(TakeFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TakeFolder& operator=(TakeFolder&&) = delete;
  const std::filesystem::path& path() const { return path_; }
  void Keep() { kept_ = true; }

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

// Makes the folder takes/<id>, or that of the next version, `id`_v2, `id`_v3, ...; making it is
// what reserves the id.
Result<TakeFolder> MakeTakeFolder(const std::filesystem::path& takes, const std::string& id);

}  // namespace articap
