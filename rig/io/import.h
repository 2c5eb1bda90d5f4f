// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/report.h"
#include "core/result.h"
#include "rig/face_rig.h"
#include "rig/io/morph_rig.h"

namespace articap {

// Any rig that is not articap's own: a folder with neutral.obj and one OBJ file a target, a glTF or
// GLB file, or MakeHuman's base.obj (its targets lie in `targets` beside it). The recipe says what
// the targets mean; without one, OBJ folders look for a recipe rig.toml, MakeHuman takes hm08's,
// and else every target is a parameter.
Result<StageResult<FaceRig>> ImportRig(const std::filesystem::path& path,
                                       const std::optional<ImportRecipe>& recipe,
                                       const ImportOptions& options);

// Its readers, from memory. `files`: file name -> bytes.
Result<MorphSource> ReadObjTargets(const std::map<std::string, std::string>& files,
                                   const std::string& source);
Result<MorphSource> ReadMakeHuman(const std::string& base_obj,
                                  const std::map<std::string, std::string>& target_files,
                                  const std::string& source);

// The recipe of MakeHuman's base mesh hm08, built in: rig/makehuman/hm08.toml.
const ImportRecipe& MakeHumanRecipe();

}  // namespace articap
