// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"

namespace articap {

// A marker map by path, or by the name of one that comes with articap ("animface"). Those are
// looked for in share/articap/maps beside the installed program, then in the source tree's maps/.
Result<std::filesystem::path> FindMap(const std::string& name_or_path);
// The same for lists of inputs that no output may replace: empty where there is none.
std::filesystem::path MapInput(const std::string& name_or_path);

}  // namespace articap
