// SPDX-License-Identifier: MIT
#include "apps/rig_input.h"

#include "rig/default_head/default_head.h"
#include "rig/io/rig_folder.h"

namespace articap {

Result<FaceRig> ChooseRig(const std::string& folder) {
  return folder.empty() ? MakeDefaultHead() : LoadRig(folder);
}

}  // namespace articap
