// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace articap {

Result<std::string> ReadFile(const std::filesystem::path& path);

// Written beside the target under a temporary name and renamed, so that nobody ever finds half a
// file. Folders on the way are made.
Result<void> WriteFile(const std::filesystem::path& path, std::string_view bytes);

// XXH3, 64 bits, as 16 hex digits.
std::string HashOf(std::string_view bytes);

}  // namespace articap
