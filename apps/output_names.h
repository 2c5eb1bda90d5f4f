// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace articap {

// What stands beside an output: take.c3d, ".pose.csv" -> take.pose.csv.
inline std::filesystem::path Beside(const std::filesystem::path& output,
                                    const std::string& ending) {
  return output.parent_path() / (output.stem().string() + ending);
}

}  // namespace articap
