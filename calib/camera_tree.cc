// SPDX-License-Identifier: MIT
#include "calib/camera_tree.h"

#include <algorithm>

namespace articap {

std::vector<bool> PlaceByPairs(const std::vector<CameraPair>& pairs, std::vector<Camera>& cameras) {
  std::vector<bool> placed(cameras.size(), false);
  placed[0] = true;
  cameras[0].cam_from_stage = {};
  for (;;) {
    const auto next = std::find_if(pairs.begin(), pairs.end(), [&](const CameraPair& pair) {
      return placed[pair.first] != placed[pair.second];
    });
    if (next == pairs.end()) return placed;
    Camera& first = cameras[next->first];
    Camera& second = cameras[next->second];
    if (placed[next->first])
      second.cam_from_stage = next->second_from_first * first.cam_from_stage;
    else
      first.cam_from_stage = next->second_from_first.Inverse() * second.cam_from_stage;
    placed[next->first] = placed[next->second] = true;
  }
}

}  // namespace articap
