// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rig/face_rig.h"
#include "rig/io/import_recipe.h"

namespace articap {

// Region names, the region of every triangle and the regions' colours, by the recipe's rules; what
// no rule takes is "other". `vertex_of_source`: where the file's vertices went, -1 for those left
// out.
Result<void> AssignRegions(const std::vector<ImportRecipe::Region>& rules,
                           const std::vector<int>& vertex_of_source,
                           const std::map<std::string, std::vector<double>>& ways_mm,
                           RigDefinition& rig);

}  // namespace articap
