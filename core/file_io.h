// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/result.h"

namespace articap {

// For reading. A folder, and what cannot be opened, fails with the reason.
Result<std::ifstream> OpenFile(const std::filesystem::path& path);
Result<std::string> ReadFile(const std::filesystem::path& path);

// Written beside the target under a temporary name and renamed, so that nobody ever finds half a
// file. Folders on the way are made.
Result<void> WriteFile(const std::filesystem::path& path, std::string_view bytes);

// Waits until a file's bytes are on the disk; false where they cannot be brought there.
bool SyncFile(const std::filesystem::path& path);

// XXH3, 64 bits, as 16 hex digits.
std::string HashOf(std::string_view bytes);

// By which a file is known again.
struct FileDigest {
  std::string xxh3;
  std::int64_t size_bytes = 0;

  bool operator==(const FileDigest&) const = default;
};

// A file of any size, a piece at a time.
Result<FileDigest> DigestOf(const std::filesystem::path& path);

// Copies byte for byte, beside `to` under a temporary name first, and gives the digest of what was
// read. It is on the disk, and not only on its way there, when this returns. `to` must not exist.
Result<FileDigest> CopyFile(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace articap
