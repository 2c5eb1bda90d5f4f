// SPDX-License-Identifier: MIT
#include "apps/rig_input.h"

#include "rig/default_head/default_head.h"
#include "rig/io/rig_folder.h"
#include "rig/pose_text.h"

namespace articap {

Result<FaceRig> ChooseRig(const std::string& folder) {
  return folder.empty() ? MakeDefaultHead() : LoadRig(folder);
}

Result<FaceRig> WithIdentityText(const FaceRig& rig, const std::vector<std::string>& assignments) {
  const auto sliders = ParseIdentity(rig, assignments);
  if (!sliders) return tl::unexpected(sliders.error());
  Eigen::VectorXd identity = rig.identity();
  for (std::size_t index = 0; index < sliders->size(); ++index)
    if ((*sliders)[index]) identity[static_cast<Eigen::Index>(index)] = *(*sliders)[index];
  return rig.WithIdentity(identity);
}

}  // namespace articap
